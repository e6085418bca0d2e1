#include "peer.h"

#include "test_util.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;

TEST(ParsePeerSummary, ReadsErrorAndSeconds) {
  const PeerResult result =
      ParsePeerSummary(R"({"material": "a.binary", "test_loss": 0.002, "train_seconds": 7.5})");
  EXPECT_EQ(result.own_error, 0.002);
  EXPECT_EQ(result.error, 0.002);  // as long as its network has not been measured
  EXPECT_EQ(result.seconds, 7.5);
}

TEST(ParsePeerSummary, SaysWhatIsMissing) {
  EXPECT_EQ(ErrorOf([] { ParsePeerSummary(R"({"test_loss": 0.002})"); }),
            "peer's summary: has no number train_seconds");
  EXPECT_EQ(ErrorOf([] { ParsePeerSummary("Traceback"); }),
            "peer's summary: has no number test_loss");
}

TEST(ParsePeerTrace, FindsColumnsByName) {
  const std::vector<FitProgress> trace = ParsePeerTrace(
      "epoch,seconds,train_loss,test_loss,extra\n1,0.5,0.03,0.04,0\n2,1,0.02,0.025,0\n");
  ASSERT_EQ(trace.size(), 2u);
  EXPECT_EQ(trace[1].iteration, 2);
  EXPECT_EQ(trace[1].seconds, 1.0);
  EXPECT_EQ(trace[1].cost, 0.02);
  EXPECT_EQ(trace[1].heldout_error, 0.025);
}

TEST(ParsePeerTrace, RejectsOtherFiles) {
  EXPECT_THAT(ErrorOf([] { ParsePeerTrace("epoch,seconds\n"); }),
              HasSubstr("no column train_loss"));
  EXPECT_THAT(ErrorOf([] { ParsePeerTrace("epoch,seconds,train_loss,test_loss\n1,2\n"); }),
              HasSubstr("a row of 2 cells below 4 columns"));
  EXPECT_THAT(ErrorOf([] { ParsePeerTrace("epoch,seconds,train_loss,test_loss\n1,x,0,0\n"); }),
              HasSubstr("'x' is not a finite number"));
}

TEST(Peer, SaysWhyItCantRun) {
  const TemporaryFolder folder;
  Peer peer{"false", folder / "absent.py", "nbrdf", 2, {}};
  EXPECT_THAT(peer.WhyUnavailable(), HasSubstr("absent.py: no such file"));
  peer.script = folder / "present.py";
  WriteBytes(peer.script, "");
  EXPECT_EQ(peer.WhyUnavailable(), "false has no module torch");
  peer.python = "no-program-of-this-name";
  EXPECT_EQ(peer.WhyUnavailable(), "no-program-of-this-name: no such program");
}

}  // namespace
}  // namespace pbnbrdf
