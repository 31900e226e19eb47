// Water that a lid leaves no room, through the program as a user runs it.
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/program.h"

namespace migiwa::testing {
namespace {

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

}  // namespace
}  // namespace migiwa::testing
