// The rules themselves, on made-up sources that keep them and that break them.
#include "tests/structure/source_rules.h"

#include <gtest/gtest.h>

namespace migiwa::structure {
namespace source_rules_test {

SourceFile file(const std::string& path, const std::string& text) {
  return {path, text};
}

void expectNone(const Violations& violations) {
  for (const std::string& violation : violations) ADD_FAILURE() << violation;
}

/// Exactly one violation for each of the given pieces of text, in that order.
void expect(const Violations& violations, const std::vector<std::string>& pieces) {
  ASSERT_EQ(violations.size(), pieces.size()) << testing::PrintToString(violations);
  for (std::size_t i = 0; i < pieces.size(); ++i)
    EXPECT_NE(violations[i].find(pieces[i]), std::string::npos) << violations[i] << "\nhas no: " << pieces[i];
}

TEST(Layers, LowerMayNotIncludeHigher) {
  expectNone(checkLayers({file("core/solver/a.cpp", "#include \"core/sph/kernels.h\"\n")}));
  expect(checkLayers({file("core/sph/a.cpp", "\n#include \"core/solver/step.h\"\n")}),
         {"core/sph/a.cpp:2 includes core/solver/step.h: core/sph lies below core/solver"});
  expect(checkLayers({file("core/io/a.cpp", "#include \"app/render/image.h\"\n")}),
         {"core/io lies below app/render"});
}

TEST(Layers, ASubfolderBelongsToItsPart) {
  expect(checkLayers({file("core/walls/inner/a.cpp", "#include \"core/scene/scene.h\"\n")}),
         {"core/walls lies below core/scene"});
  expectNone(checkLayers({file("core/walls/inner/a.cpp", "#include \"core/walls/surface.h\"\n")}));
}

TEST(Layers, PartsOfTheSameRankMayNotIncludeEachOther) {
  const SourceFile oneWay = file("core/slim/a.cpp", "#include \"core/sph/kernels.h\"\n");
  const SourceFile back = file("core/sph/b.cpp", "#include \"core/slim/a.h\"\n");
  expectNone(checkLayers({oneWay}));
  expectNone(checkLayers({back}));
  expect(checkLayers({oneWay, back}), {"in a circle"});
}

TEST(Layers, EveryFileHasItsPart) {
  expect(checkLayers({file("core/misc/a.cpp", "")}), {"core/misc/a.cpp"});
  expect(checkLayers({file("core/spherical/a.cpp", "")}), {"no known part"});
}

TEST(Chapters, AHeaderHasTwoReaders) {
  const SourceFile header = file("core/sph/a.h", "// A.\n#pragma once\n");
  const SourceFile own = file("core/sph/a.cpp", "#include \"core/sph/a.h\"\n");
  const SourceFile one = file("core/solver/b.cpp", "#include \"core/sph/a.h\"\n");
  const SourceFile two = file("tests/sph/c.cpp", "#include \"core/sph/a.h\"\n");
  expectNone(checkChapters({header, own, one, two}));
  expect(checkChapters({header, own, one}), {"core/sph/a.h: a header with fewer than two readers"});
}

TEST(Chapters, TheMedianOfARoomIsLongEnough) {
  const std::string line = "int a;\n";
  std::string longText;
  for (int k = 0; k < 120; ++k) longText += line;
  const auto room = [&](const std::string& second) {
    return std::vector<SourceFile>{file("core/sph/a.cpp", longText), file("core/sph/b.cpp", second),
                                   file("core/sph/c.cpp", line), file("core/sph/d.cpp", longText)};
  };
  expectNone(checkChapters(room(longText)));
  expect(checkChapters(room(line)), {"core/sph: half of its files have 60 lines or fewer"});
}

TEST(Borders, TheRendererNeverSeesTheSolver) {
  expectNone(checkBorders({file("app/render/a.cpp", "#include \"core/simulation/frame_view.h\"\n")}));
  EXPECT_EQ(checkBorders({file("app/render/a.cpp", "#include \"core/simulation/simulation.h\"\n"),
                          file("app/render/b.cpp", "#include \"core/solver/state.h\"\n")})
                .size(),
            2u);
}

TEST(Borders, ALibraryShowsOnlyWhereItIsWrapped) {
  expectNone(checkBorders({file("core/scene/reader.cpp", "#include <nlohmann/json.hpp>\n"),
                           file("app/render/a.cpp", "#include <glad/gl.h>\n"),
                           file("app/ui/a.cpp", "#include <imgui.h>\n")}));
  EXPECT_EQ(checkBorders({file("core/solver/a.cpp", "#include <nlohmann/json.hpp>\n")}).size(), 1u);
  EXPECT_EQ(checkBorders({file("core/io/a.cpp", "#include <glad/gl.h>\n")}).size(), 1u);
  EXPECT_EQ(checkBorders({file("app/commands/a.cpp", "#include <EGL/egl.h>\n")}).size(), 1u);
  expectNone(checkBorders({file("app/raytrace/embree.cpp", "#include <embree3/rtcore.h>\n")}));
  EXPECT_EQ(checkBorders({file("app/commands/a.cpp", "#include <embree4/rtcore.h>\n")}).size(), 1u);
  EXPECT_EQ(checkBorders({file("core/solver/a.cpp", "#include <chrono>\n#include <random>\n")}).size(), 2u);
}

TEST(Borders, AContextHasOneFile) {
  const std::string gl = "#include <GLFW/glfw3.h>\n";
  expectNone(checkBorders({file("app/platform/window.cpp", gl + gl)}));
  expect(checkBorders({file("app/platform/window.cpp", gl), file("app/platform/keys.cpp", gl)}),
         {"more than 1 file"});
}

TEST(IncludeStyle, OursAreQuotedFromTheRootAndExist) {
  const SourceFile types = file("core/base/types.h", "");
  expectNone(checkIncludeStyle(
      {types, file("core/sph/a.cpp", "#include \"core/base/types.h\"\n#include <vector>\n")}));
  expect(checkIncludeStyle({types, file("core/base/a.cpp", "#include \"types.h\"\n")}),
         {"not named from the repository's root"});
  expect(checkIncludeStyle({types, file("core/sph/a.cpp", "#include <core/base/types.h>\n")}),
         {"belongs in quotes"});
  expect(checkIncludeStyle({types, file("core/sph/a.cpp", "#include \"core/base/gone.h\"\n")}),
         {"there is no file core/base/gone.h"});
}

TEST(Habits, HeadersSayWhatTheyAreForAndAreGuarded) {
  expectNone(checkHabits({file("core/base/a.h", "// What it is for.\n#pragma once\n")}));
  EXPECT_EQ(checkHabits({file("core/base/a.h", "#include <vector>\n")}).size(), 2u);
  expectNone(checkHabits({file("core/base/a-inl.h", "// Compiled for every instruction set.\n")}));
}

TEST(Portability, NoFunctionWhoseLastDigitDiffersReachesParticles) {
  expectNone(checkPortability({file("core/slim/a.cpp", "a = std::sqrt(b) + portable::sin(c);  // std::sin\n"),
                               file("core/study/a.cpp", "a = std::log10(b);\n")}));
  expect(checkPortability({file("core/slim/a.cpp", "a = 1;\nb = std::sin(a);\n")}), {"core/slim/a.cpp:2"});
  expect(checkPortability({file("core/solver/a.cpp", "a = std::pow(b, 2) + std::hypot(c, d);\n")}),
         {"std::pow"});
  expect(checkPortability({file("core/sph/a-inl.h", "// A\nhn::ApproximateReciprocalSqrt(v)\n")}),
         {"core/sph/a-inl.h:2"});
}

TEST(Habits, NoFileIsTooLongOrUnfinished) {
  std::string text;
  for (int i = 0; i < 500; ++i) text += "\n";
  expectNone(checkHabits({file("shaders/a.frag", text)}));
  expect(checkHabits({file("shaders/a.frag", text + "\n")}), {"501 lines"});
  const std::string word = std::string("TO") + "DO";
  expect(checkHabits({file("cmake/a.cmake", "one\n# " + word + ": later\n")}), {"cmake/a.cmake:2"});
}

TEST(Habits, ATestFileHasANamespaceOfItsOwn) {
  expectNone(checkHabits({file("tests/sph/a_test.cpp", "namespace a_test {\n}\n"),
                          file("tests/sph/a.cpp", "namespace {\n}\n")}));
  expect(checkHabits({file("tests/sph/a_test.cpp", "namespace {\n}\n")}), {"unnamed namespace"});
  expect(checkHabits({file("tests/sph/a_test.cpp", "namespace b_test {\n}\n")}), {"no namespace a_test"});
}

TEST(Habits, WhatIsConstStaysSo) {
  const std::string cast = "auto& a = const_cast<A&>(b);\n";
  expect(checkHabits({file("core/scene/a.cpp", "\n" + cast)}), {"core/scene/a.cpp:2: a const_cast"});
  expectNone(checkHabits({file("tests/scene/a.cpp", cast)}));
}

}  // namespace source_rules_test
}  // namespace migiwa::structure
