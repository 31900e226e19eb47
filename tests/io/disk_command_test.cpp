// What every command that writes does where the disk is full, the folder is read-only, or it is killed on the
// way: it says so, and what is there is whole. It exits with 4 where the machine has no room, since nothing
// that was given is wrong then, and with 2 where the path is one that nobody could write.
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/base/files.h"
#include "tests/io/drop_test.h"
#include "tests/io/particle_files.h"

namespace migiwa::testing {
namespace disk_command_test {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

class DiskCommand : public DropTest {
 protected:
  void SetUp() override {
    DropTest::SetUp();
    std::ofstream(folder_ / "cube.obj")
        << "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
           "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 1 5 8 4\n";
    std::ofstream points(folder_ / "points.csv");
    points << "x,y,z\n";
    for (int k = 0; k < 200; ++k) points << "0.02," << 0.001 * k << ",0.2\n";
    fs::create_directory(folder_ / "disk");
  }

  /// Runs the program with a disk of some kilobytes mounted as `disk`, which it alone sees. `left` becomes
  /// what is on it afterwards.
  Outcome runOnSmallDisk(int kilobytes, const Words& arguments, Words& left) const {
    std::string command = "mount -t tmpfs -o size=" + std::to_string(kilobytes) +
                          "k tmpfs disk || exit 99; " + shellQuoted(MIGIWA_PROGRAM);
    for (const std::string& argument : arguments) command += " " + shellQuoted(argument);
    command += "; code=$?; find disk -type f >left; exit $code";
    const int status = std::system(("cd " + shellQuoted(folder_.string()) + " && unshare -rm sh -c " +
                                    shellQuoted(command) + " >" + shellQuoted((base_ / "out").string()) +
                                    " 2>" + shellQuoted((base_ / "err").string()))
                                       .c_str());
    left.clear();
    std::ifstream list(folder_ / "left");
    for (std::string line; std::getline(list, line);) left.push_back(line);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, readAll(base_ / "out"), readAll(base_ / "err")};
  }

  bool mayMount() const {
    return std::system(("cd " + shellQuoted(folder_.string()) +
                        " && unshare -rm mount -t tmpfs -o size=64k tmpfs disk 2>/dev/null")
                           .c_str()) == 0;
  }
};

TEST_F(DiskCommand, AFullDiskIsToldAndHoldsNoPartOfAFile) {
  if (!mayMount()) GTEST_SKIP() << "no disk may be mounted here";
  struct Writing {
    std::string what;
    int kilobytes;
    Words arguments;
  };
  const Words study{"study", "drop.json", "--vary", "/solver/max_iterations=2,3,4", "--until", "0.02"};
  const auto with = [](Words words, const Words& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  const Words simulate{"simulate", "drop.json", "--until", "0.05"};
  const std::vector<Writing> writings{
      {"a save", 16, with(simulate, {"--save", "disk/a.save"})},
      {"an export", 40, with(simulate, {"--export", "disk/out", "--every", "0.01"})},
      {"a study", 12, with(study, {"--out", "disk/out"})},
      {"a study's pictures", 64, with(study, {"--out", "disk/out"})},
      {"pictures",
       16,
       {"render", "drop.json", "--times", "0,0.01", "--size", "320x180", "--out", "disk/out"}},
      {"a sheet",
       16,
       {"render", "drop.json", "--times", "0,0.01", "--size", "320x180", "--out", "disk/out", "--compare",
        "/boundary/handling=none,gamma"}},
      {"values of gamma", 4, {"gamma", "drop.json", "--points", "points.csv", "--out", "disk/gamma.csv"}},
      {"a map of gamma", 16, {"gamma", "drop.json", "--map", "disk/out"}},
      {"a SLIM surface",
       4,
       {"slim", "cube.obj", "--degree", "1", "--nodes", "60", "--out", "disk/cube.json"}},
      {"the picture of a SLIM surface",
       32,
       {"slim", "cube.obj", "--degree", "1", "--nodes", "60", "--out", "disk/cube.json"}},
  };
  for (const Writing& writing : writings) {
    SCOPED_TRACE(writing.what);
    Words left;
    const Outcome outcome = runOnSmallDisk(writing.kilobytes, writing.arguments, left);
    EXPECT_EQ(outcome.code, 4) << outcome.err;
    EXPECT_NE(outcome.err.find("could not be written"), std::string::npos) << outcome.err;
    for (const std::string& file : left) EXPECT_EQ(file.find(".tmp"), std::string::npos) << file;
  }
}

TEST_F(DiskCommand, AFullDeviceIsToldForEveryFile) {
  for (const char* option : {"--report", "--save"}) {
    const Outcome outcome = run({"simulate", "drop.json", "--until", "0.02", option, "/dev/full"});
    EXPECT_EQ(outcome.code, 4) << option;
    EXPECT_EQ(outcome.err, "/dev/full: could not be written: No space left on device\n") << option;
  }
}

TEST_F(DiskCommand, AFileLimitIsToldAndTheOldReportStays) {
  ASSERT_EQ(run({"simulate", "drop.json", "--until", "0.02", "--report", "report.json"}).code, 0);
  const std::string old = readAll(folder_ / "report.json");
  const Outcome outcome =
      run({"simulate", "drop.json", "--until", "0.04", "--report", "report.json"}, "ulimit -f 1");
  EXPECT_EQ(outcome.code, 4);
  EXPECT_EQ(outcome.err, "report.json: could not be written: File too large\n");
  EXPECT_EQ(readAll(folder_ / "report.json"), old);
}

TEST_F(DiskCommand, AReadOnlyFolderIsRefusedBeforeTheRun) {
  // A folder in which nobody may make files, not even the one who may do all else.
  const auto refused = [&](const Words& words) {
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.code, 2) << words.back();
    EXPECT_NE(outcome.err.find(": expected a "), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("/sys/"), std::string::npos) << outcome.err;
  };
  // A run that would take hours.
  refused({"simulate", "drop.json", "--report", "/sys/report.json", "--until", "100000"});
  refused({"simulate", "drop.json", "--save", "/sys/a.save", "--until", "100000"});
  refused({"simulate", "drop.json", "--export", "/sys/out", "--every", "1", "--until", "100000"});
  refused({"study", "drop.json", "--out", "/sys/out", "--vary", "/solver/max_iterations=2,3", "--until",
           "100000"});
  refused({"render", "drop.json", "--out", "/sys/out", "--times", "100000"});
  refused({"gamma", "drop.json", "--map", "/sys/out"});
  refused({"gamma", "drop.json", "--points", "points.csv", "--out", "/sys/gamma.csv"});
  refused({"slim", "cube.obj", "--out", "/sys/cube.json"});
}

TEST_F(DiskCommand, AFullDeviceBehindTheOutputIsTold) {
  ASSERT_EQ(run({"simulate", "drop.json", "--until", "0.02", "--report", "report.json"}).code, 0);
  for (const Words& words :
       {Words{"schema"}, Words{"summary", "report.json"}, Words{"check", "drop.json", "--print"}}) {
    std::string command = "cd " + shellQuoted(folder_.string()) + " && " + shellQuoted(MIGIWA_PROGRAM);
    for (const std::string& word : words) command += " " + shellQuoted(word);
    const int status =
        std::system((command + " >/dev/full 2>" + shellQuoted((base_ / "err").string())).c_str());
    EXPECT_EQ(WEXITSTATUS(status), 4) << words[0];
    EXPECT_NE(readAll(base_ / "err").find("standard output: could not be written to its end"),
              std::string::npos)
        << words[0];
  }
}

TEST_F(DiskCommand, ADiskWithoutRoomForAFolderOrAnEmptyFileIsFull) {
  if (!mayMount()) GTEST_SKIP() << "no disk may be mounted here";
  // As many names as there may be: not even an empty file has room.
  const std::string fill = "i=0; while touch disk/$i 2>/dev/null; do i=$((i + 1)); done";
  for (const Words& words :
       {Words{"simulate", "drop.json", "--until", "0.02", "--report", "disk/report.json"},
        Words{"simulate", "drop.json", "--until", "0.02", "--export", "disk/out", "--every", "0.01"},
        Words{"study", "drop.json", "--vary", "/solver/max_iterations=2", "--until", "0.02", "--out",
              "disk/out"},
        Words{"render", "drop.json", "--times", "0", "--size", "320x180", "--out", "disk/out"},
        Words{"gamma", "drop.json", "--map", "disk/out"}}) {
    std::string command = "mount -t tmpfs -o nr_inodes=8 tmpfs disk || exit 99; " + fill + "; exec " +
                          shellQuoted(MIGIWA_PROGRAM);
    for (const std::string& word : words) command += " " + shellQuoted(word);
    const int status =
        std::system(("cd " + shellQuoted(folder_.string()) + " && unshare -rm sh -c " + shellQuoted(command) +
                     " >/dev/null 2>" + shellQuoted((base_ / "err").string()))
                        .c_str());
    const std::string err = readAll(base_ / "err");
    EXPECT_EQ(WEXITSTATUS(status), 4) << words[0] << ": " << err;
    EXPECT_NE(err.find("could not be written: No space left on device"), std::string::npos) << err;
  }
}

TEST_F(DiskCommand, AReaderThatIsGoneIsTold) {
  const int status = std::system(("cd " + shellQuoted(folder_.string()) + " && { { sleep 0.2; " +
                                  shellQuoted(MIGIWA_PROGRAM) + " schema 2>" +
                                  shellQuoted((base_ / "err").string()) + "; echo $? >code; } | true; }")
                                     .c_str());
  EXPECT_EQ(status, 0);
  EXPECT_EQ(readAll(folder_ / "code"), "4\n");
  EXPECT_NE(readAll(base_ / "err").find("standard output: could not be written"), std::string::npos);
}

TEST_F(DiskCommand, AKilledExportHasWholeFiles) {
  for (const char* seconds : {"0", "0.005", "0.011", "0.017", "0.03"}) {
    fs::remove_all(folder_ / "out");
    // The shell that becomes the program is killed some time after its third file.
    const Outcome outcome =
        run({"simulate", "drop.json", "--until", "1000", "--export", "out", "--every", "0.005"},
            "{ { while [ ! -e out/drop_000002.ply ] && kill -0 $$; do sleep 0.005; done; sleep " +
                std::string(seconds) + "; kill -9 $$; } & }");
    EXPECT_EQ(outcome.code, -1) << outcome.err;
    std::size_t whole = 0;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_ / "out")) {
      if (entry.path().extension() != ".ply") continue;
      EXPECT_EQ(readPly(readAll(entry.path())).count, 512U) << entry.path();
      ++whole;
    }
    EXPECT_GE(whole, 3U);
  }
}

TEST_F(DiskCommand, AKilledWriterLeavesTheOldFileOrTheNew) {
  // Through what all files are written by: reports, saves, pictures, tables.
  const fs::path file = folder_ / "file";
  const std::string one(1 << 20, 'a'), other(1 << 20, 'b');
  writeTextFile(file, one);
  for (int wait = 0; wait < 30; ++wait) {
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0)
      while (true) writeTextFile(file, other), writeTextFile(file, one);
    usleep(static_cast<useconds_t>(1000 + 700 * wait));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    const std::string found = readAll(file);
    EXPECT_TRUE(found == one || found == other) << found.size();
  }
}

}  // namespace disk_command_test
}  // namespace migiwa::testing
