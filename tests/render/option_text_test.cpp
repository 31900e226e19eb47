#include <gtest/gtest.h>

#include "app/commands/command.h"
#include "core/base/messages.h"

namespace migiwa {
namespace option_text_test {

/// What the single fault says, and where.
template <class Body>
std::string faultOf(const Body& body) {
  try {
    body();
  } catch (const InputError& error) {
    EXPECT_EQ(error.faults().size(), 1U);
    return error.faults().front().text();
  }
  return "no fault";
}

TEST(OptionTextTest, TimesAreSortedAndEachOnce) {
  EXPECT_EQ(parseTimes("1,0,0.5,1", "--times"), (std::vector<double>{0, 0.5, 1}));
  EXPECT_EQ(parseTimes("2.5e-1", "--times"), (std::vector<double>{0.25}));
}

TEST(OptionTextTest, BadTimesNameTheOptionAndTheWord) {
  for (const char* text : {"", "1,", "x", "-1", "nan", "inf", "1 2", "1;2", "1e7"}) {
    const std::string fault = faultOf([&] { parseTimes(text, "--times"); });
    EXPECT_TRUE(fault.starts_with("--times: expected ")) << text << ": " << fault;
    EXPECT_NE(fault.find(text), std::string::npos) << fault;
  }
}

TEST(OptionTextTest, SizeIsWidthAndHeight) {
  EXPECT_EQ(parseSize("1280x720", "--size"), (std::array<int, 2>{1280, 720}));
  for (const char* text :
       {"", "x", "1280", "1280x", "x720", "0x0", "-640x360", "1280x720x3", "99999x720", "12.5x100"}) {
    const std::string fault = faultOf([&] { parseSize(text, "--size"); });
    EXPECT_TRUE(fault.starts_with("--size: expected ")) << text << ": " << fault;
  }
}

TEST(OptionTextTest, VariantsPartAtCommasOutsideBrackets) {
  const std::vector<Override> plain = parseVariants("/boundary/handling=none,gamma", "--compare");
  ASSERT_EQ(plain.size(), 2U);
  EXPECT_EQ(plain[0].pointer, "/boundary/handling");
  EXPECT_EQ(plain[0].value, "none");
  EXPECT_EQ(plain[1].value, "gamma");
  const std::vector<Override> nested = parseVariants(R"(/gravity=[0,-9.81,0],[0,0,0])", "--compare");
  ASSERT_EQ(nested.size(), 2U);
  EXPECT_EQ(nested[1].value, "[0,0,0]");
  EXPECT_TRUE(faultOf([] { parseVariants("handling", "--compare"); }).starts_with("--compare: "));
}

}  // namespace option_text_test
}  // namespace migiwa
