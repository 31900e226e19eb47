// Water that a lid leaves no room, through the program as a user runs it.
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/program.h"

namespace migiwa::testing {
namespace squeeze_command_test {

using Json = nlohmann::ordered_json;

class SqueezeCommand : public ProgramTest {
 protected:
  std::vector<std::string> simulate(const std::vector<std::string>& more) const {
    std::vector<std::string> words{"simulate", MIGIWA_SOURCE_DIR "/scenes/hard/lid_closed.json", "--report",
                                   "report.json"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  Json report() const { return Json::parse(readAll(folder_ / "report.json")); }
};

TEST_F(SqueezeCommand, EndsWithExitCode3NamesTheTroubleAndKeepsTheLastGoodState) {
  const Outcome outcome = run(simulate({"--save", "state.migiwa"}));
  EXPECT_EQ(outcome.code, 3);
  EXPECT_NE(outcome.err.find("squeezed at step"), std::string::npos) << outcome.err;
  const Json stopped = report();
  std::string detail;
  for (const Json& trouble : stopped["trouble"])
    if (trouble["kind"] == "squeezed") detail = trouble["detail"].get<std::string>();
  // What, where, when, and what to do.
  for (const char* part : {"less room than it needs", "in the mean of all, after 0.2", "Let the fluid out"})
    EXPECT_NE(detail.find(part), std::string::npos) << part << " in: " << detail;

  // What was saved is the state that the report speaks of, and it stops at the same step again.
  const Outcome resumed = run(simulate({"--resume", "state.migiwa"}));
  EXPECT_EQ(resumed.code, 3);
  EXPECT_NE(resumed.err.find("squeezed"), std::string::npos) << resumed.err;
  EXPECT_EQ(report()["state_hash"], stopped["state_hash"]);
}

TEST_F(SqueezeCommand, NamesThePlaceAsTheSceneHasIt) {
  const auto placeFor = [&](const std::vector<std::string>& overrides) {
    EXPECT_EQ(run(simulate(overrides)).code, 3);
    const Json stopped = report();
    for (const Json& trouble : stopped["trouble"]) {
      if (trouble["kind"] != "squeezed") continue;
      const auto detail = trouble["detail"].get<std::string>();
      return std::stod(detail.substr(detail.find(" at (") + 5));
    }
    return 0.0;
  };
  const double near = placeFor({});
  const double far = placeFor(
      {"--set", "/fluid/0/min=[431250,0,0]", "--set", "/fluid/0/max=[431250.4,0.4,0.4]", "--set",
       "/boundary/surfaces/0/min=[431250,0,0]", "--set", "/boundary/surfaces/0/max=[431250.4,0.8,0.4]",
       "--set", "/boundary/surfaces/1/min=[431249.9,0.5,-0.1]", "--set",
       "/boundary/surfaces/1/max=[431250.5,1,0.5]"});
  EXPECT_GT(near, 0);
  EXPECT_LT(near, 0.4);
  // Where exactly depends on the last digits of the scene's coordinates.
  EXPECT_NEAR(far - 431250, near, 0.4);
  EXPECT_NE(far, 431250);
}

TEST_F(SqueezeCommand, ExportsTheLastGoodFrameAndSaysTroubleOnce) {
  const Outcome outcome = run(simulate({"--export", "frames", "--every", "10"}));
  EXPECT_EQ(outcome.code, 3);
  const std::size_t first = outcome.err.find("squeezed at step");
  EXPECT_NE(first, std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find("squeezed at step", first + 1), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("the last file has the last good frame, at 0.2"), std::string::npos)
      << outcome.err;
  // The start is due, the next frame after 10 s is not reached; the state that the report speaks of is there.
  Json list;
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "frames"))
    if (entry.path().string().ends_with(".ply.json")) list = Json::parse(readAll(entry.path()));
  ASSERT_EQ(list["files"].size(), 2U);
  EXPECT_EQ(list["files"].back()["state_hash"], report()["state_hash"]);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "frames" / list["files"].back()["file"].get<std::string>()));
}

}  // namespace squeeze_command_test
}  // namespace migiwa::testing
