// The program in a folder that has a scene of 512 particles: a block that is thrown into a tank.
#pragma once

#include <fstream>

#include "tests/support/program.h"

namespace migiwa::testing {

class DropTest : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    std::ofstream(folder_ / "drop.json") << R"({ "format": 1, "particle_spacing": 0.05, "duration": 0.1,
      "fluid": [ { "shape": "box", "min": [0.2, 0.2, 0], "max": [0.6, 0.6, 0.4], "velocity": [2, -3, 0] } ],
      "boundary": { "surfaces": [ { "shape": "box", "fluid": "inside", "min": [0, 0, 0],
                                    "max": [0.8, 1, 0.4] } ] } })";
  }
};

}  // namespace migiwa::testing
