// A file that is edited so that neither its name nor its size nor its time of writing tells.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

namespace migiwa::testing {

inline void rewriteUnseen(const std::filesystem::path& file, const std::string& text) {
  const auto time = std::filesystem::last_write_time(file);
  ASSERT_EQ(std::filesystem::file_size(file), text.size()) << "the size would tell";
  std::ofstream(file, std::ios::binary) << text;
  std::filesystem::last_write_time(file, time);
  ASSERT_EQ(std::filesystem::last_write_time(file), time);
}

}  // namespace migiwa::testing
