// Files of SLIM surfaces: what is written is read, and what is not one is refused with its place.
#include <gtest/gtest.h>

#include "core/base/messages.h"
#include "core/slim/file.h"
#include "tests/slim/exact_shapes.h"

namespace migiwa {
namespace slim_file_test {

SlimData someData(int degree) {
  ThreadPool pool(1);
  SlimFitOptions options;
  options.degree = degree;
  options.tolerance = degree == 1 ? 0.02 : 0.002;
  SlimData data;
  const OrientedPoints points = testing::ExactSphere{}.points(2000);
  data.nodes = fitSlim(points, options, pool);
  data.hierarchy = mergeSlim(points, data.nodes, degree, pool);
  data.degree = degree;
  data.statistics = {"ball.ply", 0.02, 0.003, 2000};
  return data;
}

std::string faultOf(const std::string& text) {
  try {
    parseSlimFile(text, "x.json");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

void expectSame(const std::vector<SlimNode>& read, const std::vector<SlimNode>& written) {
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t k = 0; k < read.size(); ++k) {
    EXPECT_EQ(read[k].centre, written[k].centre);
    EXPECT_EQ(read[k].radius, written[k].radius);
    EXPECT_EQ(read[k].normal, written[k].normal);
    EXPECT_EQ(read[k].tangent, written[k].tangent);
    EXPECT_EQ(read[k].coefficients, written[k].coefficients);
    EXPECT_EQ(read[k].error, written[k].error);
  }
}

TEST(SlimFile, ReadsWhatItWrote) {
  for (int degree = 1; degree <= 3; ++degree) {
    const SlimData written = someData(degree);
    const SlimData read = parseSlimFile(slimFileText(written), "x.json");
    EXPECT_EQ(read.degree, degree);
    EXPECT_TRUE(read.closed);
    EXPECT_EQ(read.statistics.source, "ball.ply");
    EXPECT_EQ(read.statistics.largest, 0.02);
    EXPECT_EQ(read.statistics.mean, 0.003);
    EXPECT_EQ(read.statistics.points, 2000U);
    expectSame(read.nodes, written.nodes);
    ASSERT_FALSE(written.hierarchy.merged.empty());
    expectSame(read.hierarchy.merged, written.hierarchy.merged);
    EXPECT_EQ(read.hierarchy.children, written.hierarchy.children);
  }
}

TEST(SlimFile, ReadsFilesOfVersionOneWithoutAHierarchy) {
  SlimData written = someData(2);
  written.hierarchy = {};
  const SlimData read =
      parseSlimFile(replaced(slimFileText(written), "\"version\": 2", "\"version\": 1"), "x.json");
  expectSame(read.nodes, written.nodes);
  EXPECT_TRUE(read.hierarchy.merged.empty());
}

TEST(SlimFile, RefusesEveryPrefix) {
  const std::string text = slimFileText(someData(1));
  const std::size_t end = text.find_last_of('}');
  for (std::size_t size = 0; size <= end; size += 1 + size / 50)
    EXPECT_TRUE(faultOf(text.substr(0, size)).starts_with("x.json:byte ")) << size;
}

TEST(SlimFile, RefusesForeignAndDamagedOnesWithThePlace) {
  const std::string text = slimFileText(someData(1));
  EXPECT_TRUE(faultOf("{\"format\": 1}").starts_with("x.json:/format: expected \"migiwa-slim\""));
  EXPECT_TRUE(faultOf("[]").starts_with("x.json:/format: "));
  EXPECT_EQ(faultOf(replaced(text, "\"version\": 2", "\"version\": 3")),
            "x.json:/version: expected 1 or 2, the versions that this program reads, found 3");
  EXPECT_EQ(faultOf(replaced(text, "\"degree\": 1", "\"degree\": 4")),
            "x.json:/degree: expected a whole number in [1, 3], found 4");
  EXPECT_TRUE(
      faultOf(replaced(text, "\"degree\": 1", "\"degree\": 2")).starts_with("x.json:/data: expected "));
  EXPECT_TRUE(faultOf(replaced(text, "\"closed\": true", "\"closed\": 1")).starts_with("x.json:/closed: "));
  EXPECT_TRUE(faultOf(replaced(text, "\"data\": \"", "\"data\": \"****"))
                  .starts_with("x.json:/data: expected a text"));
  EXPECT_TRUE(
      faultOf(replaced(text, "\"data\": \"", "\"data\": \"AAAA")).starts_with("x.json:/data: expected "));
}

TEST(SlimFile, RefusesNodesThatAreNone) {
  SlimData data = someData(2);
  data.nodes[3].radius = -1;
  EXPECT_TRUE(faultOf(slimFileText(data)).starts_with("x.json:/data: node 3: expected a positive radius"));
  data = someData(2);
  data.nodes[5].coefficients[4] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(faultOf(slimFileText(data)).starts_with("x.json:/data: node 5: expected finite numbers"));
  data = someData(2);
  data.nodes[0].normal *= 2;
  EXPECT_TRUE(faultOf(slimFileText(data)).starts_with("x.json:/data: node 0: expected a unit normal"));
}

TEST(SlimFile, RefusesHierarchiesThatAreNone) {
  SlimData data = someData(1);
  data.hierarchy.children[0][1] = static_cast<std::uint32_t>(data.nodes.size());
  EXPECT_TRUE(faultOf(slimFileText(data))
                  .starts_with("x.json:/hierarchy/children: node 0: expected children before their parent"));
  data = someData(1);
  data.hierarchy.children[1][0] = data.hierarchy.children[0][0];
  EXPECT_TRUE(faultOf(slimFileText(data))
                  .starts_with("x.json:/hierarchy/children: node 1: expected one parent a node"));
  data = someData(1);
  data.hierarchy.merged.back().error = 0;
  EXPECT_NE(faultOf(slimFileText(data)).find("expected an error at least as large as the children's"),
            std::string::npos);
  data = someData(1);
  data.hierarchy.children.pop_back();
  EXPECT_TRUE(faultOf(slimFileText(data)).starts_with("x.json:/hierarchy/children: expected "));
  data = someData(1);
  data.hierarchy.merged[2].centre.x() = std::numeric_limits<float>::infinity();
  EXPECT_TRUE(faultOf(slimFileText(data)).starts_with("x.json:/hierarchy/data: node 2: expected finite"));
}

}  // namespace slim_file_test
}  // namespace migiwa
