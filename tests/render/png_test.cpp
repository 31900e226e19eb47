// PNG files against a decoder that is not ours.
#include <filesystem>

#include <gtest/gtest.h>

#include "app/render/image.h"
#include "core/base/files.h"

namespace migiwa {
namespace png_test {

TEST(Png, ADecoderReadsWhatWasWritten) {
  Image image(61, 37);
  for (std::size_t i = 0; i < image.rgba.size(); ++i)
    image.rgba[i] = i % 4 == 3 ? 255 : static_cast<std::uint8_t>(i * i / 7 + i / 250 * 31);
  const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / "migiwa_png_test.png";
  for (const PngEffort effort : {PngEffort::least, PngEffort::usual}) {
    writeTextFile(file, encodePng(image, effort));
    const std::optional<Image> read = readPng(file);
    ASSERT_TRUE(read);
    EXPECT_EQ(read->width, image.width);
    EXPECT_EQ(read->rgba, image.rgba);
  }
  std::filesystem::remove(file);
}

}  // namespace png_test
}  // namespace migiwa
