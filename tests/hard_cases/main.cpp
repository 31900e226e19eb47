// The tests, or with `--write-table FILE` the table of what they measure.
#include <iostream>
#include <string_view>

#include <gtest/gtest.h>

#include "core/base/files.h"
#include "tests/hard_cases/hard_case.h"

int main(int argc, char** argv) {
  if (argc == 3 && std::string_view(argv[1]) == "--write-table") {
    migiwa::writeTextFile(argv[2], migiwa::testing::tableText());
    return 0;
  }
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
