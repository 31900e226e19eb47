// --set /json/pointer=VALUE.
#include <algorithm>

#include <gtest/gtest.h>

#include "core/base/messages.h"
#include "core/scene/scene_file.h"

namespace migiwa {
namespace override_test {

constexpr std::string_view kBase = R"({ "format": 1, "duration": 4,
  "fluid": [ { "shape": "box", "min": [0, 0, 0], "max": [1, 1, 1] } ] })";

Scene with(const std::vector<std::string>& arguments) {
  std::vector<Override> overrides;
  for (const std::string& argument : arguments) overrides.push_back(Override::parse(argument));
  return parseScene(kBase, "base.json", overrides);
}

std::string faultsOf(const std::vector<std::string>& arguments) {
  try {
    with(arguments);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Override, SetsNumbersWordsAndStructures) {
  EXPECT_EQ(with({"/duration=2.5"}).duration, 2.5);
  EXPECT_EQ(with({"/name=word"}).name, "word");
  EXPECT_EQ(with({"/name=several bare words"}).name, "several bare words");
  EXPECT_EQ(with({R"(/name="12")"}).name, "12");
  EXPECT_EQ(with({"/gravity=[1, 2, 3]"}).gravity, Vec3d(1, 2, 3));
  EXPECT_EQ(with({R"(/boundary={"handling": "none"})"}).boundary.handling, BoundaryHandling::none);
  EXPECT_FALSE(with({"/fluid/0/trim=false"}).fluid[0]->trim);
}

TEST(Override, MakesObjectsThatAreMissing) {
  EXPECT_EQ(with({"/solver/tolerance=0.5"}).solver.tolerance, 0.5);
  const Scene scene = with({"/view/clip/axis=x", "/view/clip/at=0.5"});
  EXPECT_TRUE(scene.view.clip.enabled);
  EXPECT_EQ(with({"/effects/viscosity={}"}).effects.size(), 1U);
}

TEST(Override, ReachesIntoArrays) {
  EXPECT_EQ(with({"/fluid/0/max/1=3"}).fluid[0]->bounds().max, Vec3d(1, 3, 1));
  EXPECT_EQ(
      with({"/fluid/0/shape=sphere", R"(/fluid/0={"shape": "sphere", "center": [0, 0, 0], "radius": 2})"})
          .fluid[0]
          ->bounds()
          .max,
      Vec3d(2, 2, 2));
}

TEST(Override, TheLastOneWins) {
  EXPECT_EQ(with({"/duration=1", "/duration=2"}).duration, 2);
}

TEST(Override, EverythingAfterTheFirstEqualsSignIsTheValue) {
  const Override override = Override::parse("/name=a=b");
  EXPECT_EQ(override.pointer, "/name");
  EXPECT_EQ(override.value, "a=b");
  EXPECT_EQ(Override::parse("/name=").value, "");
}

TEST(Override, IsRefusedWithoutPointerOrValue) {
  for (const char* argument : {"", "name", "name=3", "/name", "=3", "/a~=1", "/a~2b=1"})
    EXPECT_THROW(Override::parse(argument), InputError) << argument;
  EXPECT_NO_THROW(Override::parse("/a~0b~1c=1"));
}

TEST(Override, FaultsNameTheOption) {
  EXPECT_EQ(faultsOf({"/solver/tolerance=2"}),
            "--set /solver/tolerance: expected a number in [0, 1), found 2");
  EXPECT_EQ(faultsOf({"/solver/tolerance=tiny"}),
            "--set /solver/tolerance: expected a number in [0, 1), found \"tiny\"");
  EXPECT_EQ(faultsOf({R"(/solver={"tolerance": 2})"}),
            "--set /solver/tolerance: expected a number in [0, 1), found 2");
}

TEST(Override, FaultsElsewhereNameTheFile) {
  EXPECT_EQ(faultsOf({"/format=1", "/fluid/0/shape=sphere"}).find("base.json:/fluid/0/center: expected"), 0U)
      << faultsOf({"/format=1", "/fluid/0/shape=sphere"});
}

TEST(Override, UnknownKeysAreSuggested) {
  EXPECT_EQ(
      faultsOf({"/solver/tolerence=0.1"}),
      "--set /solver/tolerence: expected a known key, found \"tolerence\"; did you mean \"tolerance\"?");
  EXPECT_NE(faultsOf({"/solvr/tolerance=0.1"}).find("did you mean \"solver\"?"), std::string::npos);
}

TEST(Override, PointersHaveToLeadSomewhere) {
  EXPECT_EQ(faultsOf({"/fluid/1/trim=false"}),
            "--set /fluid/1/trim: expected the index of one of 1 entries at /fluid, found \"1\"");
  EXPECT_EQ(faultsOf({"/fluid/00/trim=false"}),
            "--set /fluid/00/trim: expected the index of one of 1 entries at /fluid, found \"00\"");
  EXPECT_EQ(faultsOf({"/fluid/-/trim=false"}),
            "--set /fluid/-/trim: expected the index of one of 1 entries at /fluid, found \"-\"");
  EXPECT_EQ(faultsOf({"/duration/x=1"}),
            "--set /duration/x: expected an object or an array at /duration, found 4");
}

TEST(Override, BrokenValuesAreNotTakenForWords) {
  EXPECT_EQ(
      faultsOf({"/gravity=[1, 2"}),
      "--set /gravity: expected ',' or ']' after the value, found the end of the text (at 1:6 of the value)");
  EXPECT_EQ(faultsOf({"/solver={\"cfl\": 1, \"cfl\": 2}"}),
            "--set /solver/cfl: expected each key once, found it again");
}

TEST(Override, AllFaultsComeAtOnce) {
  const std::string faults = faultsOf({"/duration=-1", "/solver/cfl=-1", "/fluid/7/trim=true"});
  EXPECT_EQ(std::count(faults.begin(), faults.end(), '\n'), 2) << faults;
}

}  // namespace override_test
}  // namespace migiwa
