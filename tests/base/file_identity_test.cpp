// One file is told from another by its content alone, and by that of the files which hold a part of it.
#include <fstream>

#include <gtest/gtest.h>

#include "core/base/hash.h"
#include "core/base/messages.h"
#include "tests/support/same_stamp.h"

namespace migiwa {
namespace file_identity_test {

namespace fs = std::filesystem;

class FileIdentityTest : public ::testing::Test {
 protected:
  FileIdentityTest() {
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "parts");
  }
  ~FileIdentityTest() override { fs::remove_all(folder_); }
  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }

  const fs::path folder_ =
      fs::path(::testing::TempDir()) /
      (std::string("migiwa_identity_") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(FileIdentityTest, IsThatOfTheContentAlone) {
  const fs::path first = write("first.obj", "v 0 0 1\n");
  const FileIdentity identity = identityOf(first);
  EXPECT_EQ(identity.bytes, 8U);
  EXPECT_EQ(identityOf(write("second.ply", "v 0 0 1\n")), identity);
  fs::last_write_time(first, fs::last_write_time(first) - std::chrono::hours(1));
  EXPECT_EQ(identityOf(first), identity);
  testing::rewriteUnseen(first, "v 0 0 2\n");
  EXPECT_NE(identityOf(first), identity);
  EXPECT_NE(identityOf(first).text(), identity.text());
  // Filled up with zeros, the last words would be the same.
  EXPECT_NE(identityOf(write("zero", std::string("a\0", 2))), identityOf(write("none", "a")));
}

TEST_F(FileIdentityTest, EveryByteOfALongFileCounts) {
  std::string text(200001, 'x');
  const FileIdentity identity = identityOf(write("long", text));
  for (const std::size_t at : {std::size_t{0}, std::size_t{65535}, std::size_t{65536}, text.size() - 1}) {
    std::string changed = text;
    changed[at] = 'y';
    EXPECT_NE(identityOf(write("long", changed)), identity) << at;
  }
}

TEST_F(FileIdentityTest, WhatIsNoOrdinaryFileHasNothingInIt) {
  for (const fs::path& file : {folder_ / "none", folder_, fs::path("/dev/zero")})
    EXPECT_EQ(identityOf(file).bytes, 0U) << file;
}

TEST_F(FileIdentityTest, BuffersOfAGltfFileBelongToIt) {
  write("parts/a b.bin", "12345678");
  write("wood.bin", "abcdefgh");
  const fs::path file = write("shape.gltf", R"({ "buffers": [
      { "byteLength": 8, "uri" : "parts/a%20b.bin" }, { "uri": "wood.bin" },
      { "uri": "data:application/octet-stream;base64,AAAA" } ], "note": "uri" })");
  const FileIdentity identity = identityOf(file);
  EXPECT_EQ(identity.bytes, fs::file_size(file) + 16);
  testing::rewriteUnseen(folder_ / "parts/a b.bin", "12345679");
  EXPECT_NE(identityOf(file), identity);
  const std::vector<fs::path> files = filesOfShape(file);
  EXPECT_NE(std::find(files.begin(), files.end(), folder_ / "wood.bin"), files.end());
  // An OBJ file's materials are not part of its shape.
  EXPECT_EQ(filesOfShape(write("plain.obj", "mtllib wood.mtl\n")).size(), 1U);
}

TEST_F(FileIdentityTest, AChangeWhileAFileIsReadIsAFault) {
  const fs::path file = write("mesh.obj", "v 0 0 1\n");
  const FileIdentity identity = identityOf(file);
  EXPECT_NO_THROW(requireUnchanged(file, identity));
  testing::rewriteUnseen(file, "v 0 0 2\n");
  try {
    requireUnchanged(file, identity);
    ADD_FAILURE() << "was accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.faults().front().place, file.string());
  }
}

}  // namespace file_identity_test
}  // namespace migiwa
