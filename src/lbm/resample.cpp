// SPDX-License-Identifier: GPL-3.0-or-later
// Cells are handled in lines of up to 16: along x, or along y where few cells are read along x (rims at an x face).
// Lines are combined with whole vectors along the two other axes, and along themselves last, by permuting lanes.
#include "lbm/resample.hpp"

#include <algorithm>

namespace drogue::lbm {
namespace {

constexpr int n = amr::block_size;
constexpr int reach = 2;  // cells outside the source block that a stencil may use
constexpr int interpolation_taps = 4, restriction_taps = 5;

/// Lagrange weights of the points 0, 1, 2, 3 at position x.
std::array<double, Axis::most_taps> cubic_weights(double x) {
  std::array<double, Axis::most_taps> w{};
  for (int k = 0; k < 4; ++k) {
    double product = 1.0;
    for (int l = 0; l < 4; ++l)
      if (l != k) product *= (x - l) / (k - l);
    w[k] = product;
  }
  return w;
}

template <class Real>
constexpr IndexVec<Real> lane_numbers{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

/// Reads lines of one moment in and around a block: 16 cells from the first on. `midway`: half-way through a coarse
/// step they are the mean of its two ends.
template <class S, bool midway>
class LineReader {
 public:
  using Layout = RowLayout<S>;
  using Real = typename S::Real;

  LineReader(const ResampleJob& job, const amr::Forest& forest, const SourceFields<S>& source, const Axis& along)
      : first_(along.first_input()),
        count_(along.inputs()),
        y0_(job.axis[1].first_input()),
        z0_(job.axis[2].first_input()) {
    point_at_rows(job, forest, source.leaves, source.parents, start_);
    if constexpr (midway) point_at_rows(job, forest, *source.leaves_end, source.parents, end_);
  }

  Vec<Real> along_x(int m, int y, int z) const {
    const Vec<Real> line = lanes_along_x(start_, m, y, z);
    if constexpr (midway) return Real(0.5) * (line + lanes_along_x(end_, m, y, z));
    return line;
  }

  Vec<Real> along_y(int m, int x, int z) const {
    const Vec<Real> line = gather(start_, m, x, z);
    if constexpr (midway) return Real(0.5) * (line + gather(end_, m, x, z));
    return line;
  }

 private:
  /// Rows by [dx + 1][z - z0][y - y0].
  using Rows = std::array<std::array<std::array<const std::byte*, n>, n>, 3>;

  void point_at_rows(const ResampleJob& job, const amr::Forest& forest, const MomentField<S>& leaves,
                     const MomentField<S>& parents, Rows& rows) {
    const auto& neighbour = forest.block(job.source).neighbour;
    const int x0 = job.axis[0].first_input(), x1 = job.axis[0].last_input();
    for (int dx = x0 < 0 ? -1 : 0; dx <= (x1 >= n ? 1 : 0); ++dx)
      for (int z = z0_; z <= job.axis[2].last_input(); ++z)
        for (int y = y0_; y <= job.axis[1].last_input(); ++y) {
          const int slot = amr::neighbour_slot(dx, (y >= n) - (y < 0), (z >= n) - (z < 0));
          // what no stencil uses is read from the block itself and weighted with zero
          const int id = neighbour[slot] == amr::none ? job.source : neighbour[slot];
          const MomentField<S>& field = forest.block(id).kind == amr::Kind::parent ? parents : leaves;
          const std::byte* row = field.row(id, y & (n - 1), z & (n - 1));
          rows[dx + 1][z - z0_][y - y0_] = row;
          for (std::size_t line = 0; line < Layout::bytes; line += 64) __builtin_prefetch(row + line);
        }
  }

  Vec<Real> lanes_along_x(const Rows& rows, int m, int y, int z) const {
    const auto row = [&](int dx) { return Layout::load(rows[dx + 1][z - z0_][y - y0_], m); };
    const int dx = first_ < 0 ? -1 : 0, within = first_ - dx * n;
    if (within == 0) return row(dx);
    const Vec<Real> line = row(dx);
    return __builtin_shuffle(line, within + count_ > n ? row(dx + 1) : line, lane_numbers<Real> + within);
  }

  Vec<Real> gather(const Rows& rows, int m, int x, int z) const {
    const int dx = (x >= n) - (x < 0);
    const auto* row = rows[dx + 1][z - z0_].data();
    const auto elements = [&](auto* element, auto address) {
      for (int i = 0; i < count_; ++i) element[i] = address(row[i], m)[x - dx * n];
    };
    if (m < 4) {
      alignas(128) Real element[lanes] = {};
      elements(element, [](const std::byte* r, int k) { return Layout::macro(r, k); });
      return load(element);
    }
    alignas(128) typename S::Element element[lanes] = {};
    elements(element, [](const std::byte* r, int k) { return Layout::stress(r, k); });
    return S::load(element);
  }

  int first_, count_;  // cells along the lines
  int y0_, z0_;
  Rows start_, end_;
};

/// An axis with its inputs and outputs counted from 0 and a number of taps the compiler knows.
template <class Real, int taps>
struct Stencil {
  int outputs;
  std::array<int, n> start{};
  std::array<std::array<Real, taps>, n> weight{};

  explicit Stencil(const Axis& axis) : outputs(axis.outputs()) {
    for (int i = 0; i < outputs; ++i) {
      start[i] = axis.start[axis.begin + i] - axis.first_input();
      for (int k = 0; k < taps; ++k) weight[i][k] = static_cast<Real>(axis.weight[axis.begin + i][k]);
    }
  }

  /// Output i of lines that stand `stride` apart.
  Vec<Real> operator()(int i, const Vec<Real>* in, int stride) const {
    const Vec<Real>* from = in + start[i] * stride;
    Vec<Real> sum = weight[i][0] * from[0];
    for (int k = 1; k < taps; ++k) sum += weight[i][k] * from[k * stride];
    return sum;
  }
};

/// The last pass: output lane i is the weighted sum of lanes of a line.
template <class Real, int taps>
class LaneCombination {
 public:
  explicit LaneCombination(const Stencil<Real, taps>& axis) {
    for (int k = 0; k < taps; ++k)
      for (int i = 0; i < axis.outputs; ++i) {
        lane_[k][i] = axis.start[i] + k;
        weight_[k][i] = axis.weight[i][k];
      }
  }

  Vec<Real> operator()(const Vec<Real>& line) const {
    Vec<Real> sum = weight_[0] * __builtin_shuffle(line, lane_[0]);
    for (int k = 1; k < taps; ++k) sum += weight_[k] * __builtin_shuffle(line, lane_[k]);
    return sum;
  }

 private:
  std::array<IndexVec<Real>, taps> lane_{};
  std::array<Vec<Real>, taps> weight_{};
};

/// Writes `count` lanes from cell x on.
template <class S>
void write_along_x(std::byte* row, int m, int x, int count, Vec<typename S::Real> v) {
  using Layout = RowLayout<S>;
  if (count == n) return Layout::store(row, m, v);
  if (m < 4) {
    for (int i = 0; i < count; ++i) Layout::macro(row, m)[x + i] = v[i];
  } else {
    alignas(128) typename S::Element e[lanes];
    S::store(e, v);
    std::copy_n(e, count, Layout::stress(row, m) + x);
  }
}

template <class S>
void write_along_y(std::byte* block, int m, const Index3& cell, int count, Vec<typename S::Real> v) {
  using Layout = RowLayout<S>;
  const auto write = [&](const auto* e, auto address) {
    for (int i = 0; i < count; ++i) address(block + (cell[2] * n + cell[1] + i) * Layout::bytes, m)[cell[0]] = e[i];
  };
  if (m < 4) {
    alignas(128) typename S::Real e[lanes];
    store(e, v);
    write(e, [](std::byte* r, int k) { return Layout::macro(r, k); });
  } else {
    alignas(128) typename S::Element e[lanes];
    S::store(e, v);
    write(e, [](std::byte* r, int k) { return Layout::stress(r, k); });
  }
}

/// Flattened, or GCC 12 passes the lines through memory from call to call.
template <class S, int taps, bool midway>
[[gnu::flatten]] void run(const ResampleJob& job, const amr::Forest& forest, const SourceFields<S>& source,
                          const Conversion& conversion, MomentField<S>& target) {
  using Real = typename S::Real;
  using Plane = Vec<Real>[n][n];  // of lines, [z][p] with p the axis that is neither z nor along the lines
  const bool x_lines = job.axis[0].inputs() > 4;
  const Axis &along = job.axis[x_lines ? 0 : 1], &across = job.axis[x_lines ? 1 : 0];
  const LineReader<S, midway> reader(job, forest, source, along);
  const Stencil<Real, taps> p(across), z(job.axis[2]);
  const LaneCombination<Real, taps> combine_lanes{Stencil<Real, taps>(along)};
  const int p0 = across.first_input(), z0 = job.axis[2].first_input();
  const int rows = job.axis[2].inputs(), columns = across.inputs();
  Plane in, half, out;
  for (int m = 0; m < moments; ++m) {
    for (int r = 0; r < rows; ++r)
      for (int c = 0; c < columns; ++c)
        in[r][c] = x_lines ? reader.along_x(m, p0 + c, z0 + r) : reader.along_y(m, p0 + c, z0 + r);
    if (z.outputs < p.outputs) {  // the axis that leaves less to do first
      for (int i = 0; i < z.outputs; ++i)
        for (int c = 0; c < columns; ++c) half[i][c] = z(i, &in[0][c], n);
      for (int r = 0; r < z.outputs; ++r)
        for (int i = 0; i < p.outputs; ++i) out[r][i] = p(i, half[r], 1);
    } else {
      for (int r = 0; r < rows; ++r)
        for (int i = 0; i < p.outputs; ++i) half[r][i] = p(i, in[r], 1);
      for (int i = 0; i < z.outputs; ++i)
        for (int c = 0; c < p.outputs; ++c) out[i][c] = z(i, &half[0][c], n);
    }
    const Real factor = m < 4 ? Real(1) : static_cast<Real>(conversion.stress_factor);
    const Real shift = m >= ux && m <= uz ? static_cast<Real>(conversion.velocity_shift[m - ux]) : Real(0);
    for (int r = 0; r < z.outputs; ++r)
      for (int c = 0; c < p.outputs; ++c) {
        const Vec<Real> v = factor * combine_lanes(out[r][c]) + shift;
        const int zt = job.axis[2].begin + r + job.shift[2];
        if (x_lines)
          write_along_x<S>(target.row(job.target, across.begin + c + job.shift[1], zt), m, along.begin + job.shift[0],
                           along.outputs(), v);
        else
          write_along_y<S>(target.block(job.target), m,
                           {across.begin + c + job.shift[0], along.begin + job.shift[1], zt}, along.outputs(), v);
      }
  }
}

}  // namespace

int Axis::first_input() const { return *std::min_element(start.begin() + begin, start.begin() + end); }

int Axis::last_input() const { return *std::max_element(start.begin() + begin, start.begin() + end) + taps - 1; }

Axis cubic_axis(int begin, int end, int half, std::array<bool, 2> available) {
  Axis axis{begin, end, interpolation_taps, {}, {}};
  const int low = available[0] ? -reach : 0, high = (available[1] ? n + reach : n) - axis.taps;
  for (int i = begin; i < end; ++i) {
    const int coarse = half * n / 2 + i / 2, odd = i & 1;
    axis.start[i] = std::clamp(coarse - 2 + odd, low, high);
    axis.weight[i] = cubic_weights(coarse + (odd ? 0.25 : -0.25) - axis.start[i]);
  }
  return axis;
}

Axis restriction_axis(int begin, int end) {
  Axis axis{begin, end, restriction_taps, {}, {}};
  for (int i = begin; i < end; ++i) {
    // the centred four points stand in five taps
    axis.start[i] = 2 * i - 1;
    axis.weight[i] = {-1, 9, 9, -1, 0};
    if (i == 0) {
      axis.start[i] = 0;
      axis.weight[i] = {6, 11, 1, -3, 1};
    }
    if (i == n / 2 - 1) {
      axis.start[i] = n - 5;
      axis.weight[i] = {1, -3, 1, 11, 6};
    }
    for (double& w : axis.weight[i]) w /= 16.0;
  }
  return axis;
}

template <class S>
void resample(const ResampleJob& job, const amr::Forest& forest, const SourceFields<S>& source,
              const Conversion& conversion, MomentField<S>& target) {
  if (job.axis[0].taps == restriction_taps)
    run<S, restriction_taps, false>(job, forest, source, conversion, target);
  else if (source.leaves_end)
    run<S, interpolation_taps, true>(job, forest, source, conversion, target);
  else
    run<S, interpolation_taps, false>(job, forest, source, conversion, target);
}

#ifdef __F16C__
template void resample(const ResampleJob&, const amr::Forest&, const SourceFields<HalfStress>&, const Conversion&,
                       MomentField<HalfStress>&);
#endif
template void resample(const ResampleJob&, const amr::Forest&, const SourceFields<FloatStress>&, const Conversion&,
                       MomentField<FloatStress>&);
template void resample(const ResampleJob&, const amr::Forest&, const SourceFields<DoubleStress>&, const Conversion&,
                       MomentField<DoubleStress>&);

}  // namespace drogue::lbm
