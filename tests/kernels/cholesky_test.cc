#include "kernels/cholesky.h"

#include "test_util.h"

namespace pbnbrdf {
namespace {

// B B' + shift, B random, size x rank.
std::vector<double> RandomGram(int size, int rank, double shift) {
  const std::vector<double> b = RandomNumbers(size * rank, -1.0, 1.0, /*seed=*/1);
  std::vector<double> a(size * size);
  for (int i = 0; i < size; ++i) {
    for (int j = 0; j < size; ++j) {
      for (int k = 0; k < rank; ++k) a[i * size + j] += b[i * rank + k] * b[j * rank + k];
      if (i == j) a[i * size + j] += shift;
    }
  }
  return a;
}

void Fill(const std::vector<double>& a, Cholesky* cholesky) {
  for (int i = 0; i < cholesky->size(); ++i) {
    std::copy_n(&a[i * cholesky->size()], i + 1, cholesky->row(i));
  }
}

TEST(Cholesky, SolvesLinearSystems) {
  for (int size : {1, 2, 15, 16, 17, 33, 100, 203}) {
    const std::vector<double> a = RandomGram(size, size + 5, 0.1);
    const std::vector<double> x = RandomNumbers(size, -1.0, 1.0, /*seed=*/2);
    std::vector<double> b(size);
    for (int i = 0; i < size; ++i) {
      for (int j = 0; j < size; ++j) b[i] += a[i * size + j] * x[j];
    }
    Cholesky cholesky(size);
    Fill(a, &cholesky);
    ASSERT_TRUE(cholesky.Factor()) << size;
    for (int i = 0; i < size; ++i) {
      for (int j = 0; j <= i; ++j) {
        double product = 0.0;
        for (int k = 0; k <= j; ++k) product += cholesky.row(i)[k] * cholesky.row(j)[k];
        ASSERT_NEAR(product, a[i * size + j], 1e-12 * size) << i << ", " << j << " of " << size;
      }
    }
    std::vector<double> lower = b;
    cholesky.Solve(b.data());
    for (int i = 0; i < size; ++i) ASSERT_NEAR(b[i], x[i], 1e-8) << size;
    const std::vector<double> right = lower;
    cholesky.SolveLower(lower.data());
    for (int i = 0; i < size; ++i) {
      double sum = 0.0;
      for (int k = 0; k <= i; ++k) sum += cholesky.row(i)[k] * lower[k];
      ASSERT_NEAR(sum, right[i], 1e-10 * size);
    }
  }
}

TEST(Cholesky, RefusesWhatIsNotPositiveDefinite) {
  for (int size : {1, 20, 50}) {
    Cholesky cholesky(size);
    Fill(RandomGram(size, size, /*shift=*/-2.0 * size), &cholesky);
    EXPECT_FALSE(cholesky.Factor());
    Fill(std::vector<double>(size * size, std::nan("")), &cholesky);
    EXPECT_FALSE(cholesky.Factor());
  }
}

}  // namespace
}  // namespace pbnbrdf
