#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/messages.h"

namespace migiwa {
namespace error_test {

TEST(InputError, CarriesEveryFaultAndSaysThemAll) {
  const std::vector<Fault> faults{{"a.json:/gravity", "expected 3 numbers, found 2"},
                                  {"a.json:/name", "expected text"}};
  const InputError error(faults);
  ASSERT_EQ(error.faults().size(), 2u);
  EXPECT_EQ(error.faults()[0].text(), "a.json:/gravity: expected 3 numbers, found 2");
  EXPECT_EQ(std::string(error.what()),
            "a.json:/gravity: expected 3 numbers, found 2\na.json:/name: expected text");
}

TEST(InputError, OneFaultNeedsNoList) {
  const InputError error("--until", "expected a number");
  ASSERT_EQ(error.faults().size(), 1u);
  EXPECT_EQ(std::string(error.what()), "--until: expected a number");
}

}  // namespace error_test
}  // namespace migiwa
