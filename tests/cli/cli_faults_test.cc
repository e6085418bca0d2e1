// What is left when a command is ended from outside, and when the disk is full: files as they were, or whole ones.
#include <sys/mount.h>

#include <chrono>
#include <random>
#include <thread>

#include "cli_fixture.h"
#include "pbnbrdf/network/neural_brdf.h"

namespace pbnbrdf {
namespace {

struct Job {
  std::string name, command;  // that writes OUT; takes one to a few seconds
  std::string check;          // a command that succeeds on a whole OUT
};

class CliFaults : public Cli {
 protected:
  // Each has its own output, replacing one that is there.
  std::vector<Job> Jobs() {
    const std::string fit = Path("fit.safetensors");
    EXPECT_EQ(Run("fit --material=builtin:satin-gold" + kQuick + "--out=" + fit).status, 0);
    std::vector<Job> jobs = {
        {"fit.out", "fit --quiet --material=builtin:satin-gold --max_iterations=100 --out=OUT",
         "info OUT"},
        {"merl.out", "export --format=merl --material=" + fit + " --out=OUT", "info OUT"}};
#ifdef PBNBRDF_HAS_RENDER
    const std::string scene = " --scene=" PBNBRDF_PROBLEMS "/scenes/sphere.json ";
    jobs.push_back({"render.out", "render --quiet" + scene + "--samples_per_pixel=4 --out=OUT",
                    "compare OUT OUT"});
    jobs.push_back({"report.out", "report --fit=" + fit + " --out=OUT", ""});
#endif
    return jobs;
  }

  static std::string With(std::string command, const std::string& out) {
    for (std::size_t at; (at = command.find("OUT")) != command.npos;) command.replace(at, 3, out);
    return command;
  }

  // Runs the command and sends it the signal after so many seconds.
  void RunUntil(const std::string& signal, double seconds, const std::string& command) const {
    std::ignore = std::system(StrCat("timeout --foreground -s ", signal, " ", seconds, " ",
                                     PBNBRDF_PROGRAM, " ", command, " > ", Path("log"), " 2>&1")
                                  .c_str());
  }

  // That the file is the old one, or whole.
  void ExpectOldOrWhole(const Job& job, const std::string& path, const std::string& when) {
    const std::string content = ReadFile(path, 1 << 30);
    if (content == kOld) return;
    if (!job.check.empty()) {
      EXPECT_EQ(Run(With(job.check, path)).status, 0) << job.command << " " << when;
    } else {
      EXPECT_THAT(content.substr(content.size() - 10), HasSubstr("</html>")) << when;
    }
  }

  const std::string kOld = "what was there before";
};

TEST_F(CliFaults, EndedAtAnyMomentByAnySignalItLeavesWholeFiles) {
  std::mt19937 random(1);
  for (const Job& job : Jobs()) {
    std::filesystem::create_directory(Path("to"));
    const std::string out = Path("to/" + job.name);
    for (const char* signal : {"INT", "TERM", "KILL"}) {
      for (const double most : {0.2, 2.0}) {
        WriteBytes(out, kOld);
        const double seconds = std::uniform_real_distribution<double>(0.01, most)(random);
        const std::string when = StrCat("SIG", signal, " after ", seconds, " s");
        RunUntil(signal, seconds, With(job.command, out));
        ExpectOldOrWhole(job, out, when);
        // Only what can't be caught leaves a part behind.
        if (std::string(signal) != "KILL") {
          EXPECT_EQ(std::distance(std::filesystem::directory_iterator(Path("to")), {}), 1) << when;
        }
      }
    }
    std::filesystem::remove_all(Path("to"));
  }
}

// The networks of a scene, or of a folder of materials, are each there as a whole or not at all; the same command
// goes on.
TEST_F(CliFaults, ManyFitsAreLeftWholeEach) {
  std::vector<std::string> commands = {"fit --jobs=2 --material='builtin:*'" + kQuick +
                                       "--out_dir=" + Path("to")};
#ifdef PBNBRDF_HAS_RENDER
  commands.push_back("fit-scene --scene=" PBNBRDF_PROBLEMS "/scenes/gallery.json" + kQuick +
                     "--out_dir=" + Path("to"));
#endif
  std::mt19937 random(2);
  std::uniform_real_distribution<double> seconds(0.01, 3.0);
  for (const std::string& command : commands) {
    for (const char* signal : {"INT", "TERM", "KILL", "INT", "TERM", "KILL"}) {
      RunUntil(signal, seconds(random), command);
      if (!std::filesystem::exists(Path("to"))) continue;
      for (const auto& file : std::filesystem::directory_iterator(Path("to"))) {
        const std::string extension = file.path().extension();
        if (extension == ".safetensors") {
          EXPECT_NO_THROW(NeuralBrdf::Read(file.path())) << signal;
        }
        if (extension == ".part") {
          EXPECT_STREQ(signal, "KILL");
        }
      }
    }
    EXPECT_EQ(Run(command + " --quiet").status, 0) << command;
    std::filesystem::remove_all(Path("to"));
  }
}

// What is cut or deleted while it is read is refused in one line, or was read before.
TEST_F(CliFaults, AFileMayChangeUnderItsReader) {
  const std::string table = Path("table.binary"), out = Path("out.csv");
  ASSERT_EQ(Run("export --format=merl --material=builtin:satin-gold --out=" + table).status, 0);
  const std::string whole = ReadFile(table, 1 << 26);
  WriteBytes(Path("pairs.csv"), "theta_i,phi_i,theta_o,phi_o\n0.5,0,0.5,3\n");
  std::mt19937 random(3);
  std::uniform_real_distribution<double> seconds(0.0, 0.1);
  for (int k = 0; k < 10; ++k) {
    WriteBytes(table, whole);
    std::thread other([&, wait = seconds(random)] {
      std::this_thread::sleep_for(std::chrono::duration<double>(wait));
      if (k % 2 == 0) {
        std::filesystem::resize_file(table, whole.size() / 2);
      } else {
        std::filesystem::remove(table);
      }
    });
    const Result result =
        Run("eval --material=" + table + " --directions=" + Path("pairs.csv") + " --out=" + out);
    other.join();
    if (result.status == 0) {
      std::filesystem::remove(out);
      continue;
    }
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.err, StartsWith("pbnbrdf: " + table + ": "));
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_FALSE(std::filesystem::exists(out));
  }
}

// A file system of 16 KiB, for as long as this lives.
class SmallDisk {
 public:
  explicit SmallDisk(const std::string& folder) : folder_(folder) {
    std::filesystem::create_directory(folder);
    is_there_ = mount("tmpfs", folder.c_str(), "tmpfs", 0, "size=16k") == 0;
  }
  ~SmallDisk() {
    if (is_there_) umount2(folder_.c_str(), MNT_DETACH);
  }
  bool is_there() const { return is_there_; }

 private:
  const std::string folder_;
  bool is_there_;
};

TEST_F(CliFaults, AFullDiskIsSaidAndLeavesWhatWasThere) {
  const SmallDisk disk(Path("disk"));
  if (!disk.is_there()) GTEST_SKIP() << "needs the right to mount a file system";
  WriteBytes(Path("disk/filler"), std::string(8192, 'x'));
  for (const Job& job : Jobs()) {
    if (job.check.empty()) continue;  // a report takes long, and is written as the others are
    const std::string out = Path("disk/" + job.name);
    WriteBytes(out, kOld);
    const Result result = Run(With(job.command, out));
    EXPECT_EQ(result.status, 1) << job.command;
    EXPECT_THAT(result.err, HasSubstr("No space left on device"));
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_TRUE(ReadFile(out, 1 << 20) == kOld) << job.command;
    std::filesystem::remove(out);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(Path("disk")), {}), 1);
  }
}

}  // namespace
}  // namespace pbnbrdf
