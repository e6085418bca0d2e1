// What is left when a command is ended from outside, and when the disk is full: files as they were, or whole ones.
#include <sys/mount.h>

#include <random>

#include "cli_fixture.h"

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
        std::ignore = std::system(StrCat("timeout -s ", signal, " ", seconds, " ", PBNBRDF_PROGRAM,
                                         " ", With(job.command, out), " > ", Path("log"), " 2>&1")
                                      .c_str());
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
