// GoogleTest's own main, and one option more: --update-golden writes the golden pictures and does nothing
// else.
#include <string_view>

#include <gtest/gtest.h>

#include "tests/render/golden.h"

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  if (argc > 1 && std::string_view(argv[1]) == "--update-golden") {
    migiwa::updateGolden = true;
    GTEST_FLAG_SET(filter, "Scenes/GoldenTest.*");
  }
  return RUN_ALL_TESTS();
}
