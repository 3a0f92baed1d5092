// SPDX-License-Identifier: GPL-3.0-or-later
// Cells are handled in lines of up to 16 or 32: along x where the box is wide in x, else along y (a box at an x face is
// one or two cells wide there). Lines are combined with whole vectors along the two other axes, and along themselves
// last, by permuting lanes.
#include "lbm/resample.hpp"

#include <algorithm>

namespace drogue::lbm {
namespace {

constexpr int n = amr::block_size;
constexpr int reach = 2;  // cells outside the source block that a stencil may use
constexpr int widest = n + 2 * reach;

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

/// V vectors: cells first, first + 1, ... along the axis of the lines.
template <class Real, int V>
using Line = std::array<Vec<Real>, V>;

/// Reads lines of one moment in and around a block; half-way through a coarse step they are the mean of its two ends.
template <class S, int V>
class LineReader {
 public:
  using Layout = RowLayout<S>;
  using Real = typename S::Real;
  using Line = lbm::Line<Real, V>;

  LineReader(const ResampleJob& job, const amr::Forest& forest, const SourceFields<S>& source, const Axis& along)
      : first_(along.first_input()),
        count_(along.inputs()),
        y0_(job.axis[1].first_input()),
        z0_(job.axis[2].first_input()),
        midway_(source.leaves_end != nullptr) {
    point_at_rows(job, forest, source.leaves, source.parents, start_);
    if (midway_) point_at_rows(job, forest, *source.leaves_end, source.parents, end_);
  }

  Line along_x(int m, int y, int z) const {
    const Line line = lanes_along_x(start_, m, y, z);
    return midway_ ? mean(line, lanes_along_x(end_, m, y, z)) : line;
  }

  Line along_y(int m, int x, int z) const {
    const Line line = m < 4 ? gather<Real>(start_, m * lanes * sizeof(Real), x, z)
                            : gather<typename S::Element>(start_, stress_offset(m), x, z);
    if (!midway_) return line;
    return mean(line, m < 4 ? gather<Real>(end_, m * lanes * sizeof(Real), x, z)
                            : gather<typename S::Element>(end_, stress_offset(m), x, z));
  }

 private:
  /// Rows by [dx + 1][z - z0][y - y0].
  using Rows = std::array<std::array<std::array<const std::byte*, widest>, widest>, 3>;

  static std::size_t stress_offset(int m) {
    return Layout::macro_bytes + (m - 4) * lanes * sizeof(typename S::Element);
  }

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

  Line lanes_along_x(const Rows& rows, int m, int y, int z) const {
    const auto row = [&](int dx) { return Layout::load(rows[dx + 1][z - z0_][y - y0_], m); };
    Line line;
    for (int v = 0; v < V; ++v) {
      const int x = first_ + v * lanes, dx = x < 0 ? -1 : x / n, within = x - dx * n;
      line[v] = row(dx);
      if (within + std::min(count_ - v * lanes, lanes) > n)
        line[v] = __builtin_shuffle(line[v], row(dx + 1), lane_numbers<Real> + within);
      else if (within != 0)
        line[v] = __builtin_shuffle(line[v], line[v], lane_numbers<Real> + within);
    }
    return line;
  }

  template <class Element>
  Line gather(const Rows& rows, std::size_t offset, int x, int z) const {
    alignas(128) Element element[V * lanes] = {};
    const int dx = (x >= n) - (x < 0);
    const auto* row = rows[dx + 1][z - z0_].data();
    offset += (x - dx * n) * sizeof(Element);
    for (int i = 0; i < count_; ++i) element[i] = *reinterpret_cast<const Element*>(row[i] + offset);
    Line line;
    for (int v = 0; v < V; ++v) {
      if constexpr (std::is_same_v<Element, Real>)
        line[v] = load(element + v * lanes);
      else
        line[v] = S::load(element + v * lanes);
    }
    return line;
  }

  static Line mean(Line a, const Line& b) {
    for (int v = 0; v < V; ++v) a[v] = Real(0.5) * (a[v] + b[v]);
    return a;
  }

  int first_, count_;  // cells along the lines
  int y0_, z0_;
  bool midway_;
  Rows start_, end_;
};

/// The last pass: output lane i is the weighted sum of lanes of a line.
template <class Real, int V>
class LaneCombination {
 public:
  explicit LaneCombination(const Axis& axis) : taps_(axis.taps) {
    for (int k = 0; k < taps_; ++k)
      for (int i = axis.begin; i < axis.end; ++i) {
        lane_[k][i - axis.begin] = axis.start[i] + k - axis.first_input();
        weight_[k][i - axis.begin] = axis.weight[i][k];
      }
  }

  Vec<Real> operator()(const Line<Real, V>& line) const {
    Vec<Real> sum{};
    for (int k = 0; k < taps_; ++k) sum += weight_[k] * __builtin_shuffle(line[0], line[V - 1], lane_[k]);
    return sum;
  }

 private:
  int taps_;
  std::array<IndexVec<Real>, Axis::most_taps> lane_{};
  std::array<Vec<Real>, Axis::most_taps> weight_{};
};

/// A plane of lines, [z][p] with p the axis that is neither z nor along the lines.
template <class Real, int V>
using Plane = Line<Real, V>[widest][widest];

template <class Real, int V>
void combine_z(const Axis& z, int columns, const Plane<Real, V>& in, Plane<Real, V>& out) {
  const int first = z.first_input();
  for (int i = z.begin; i < z.end; ++i)
    for (int c = 0; c < columns; ++c)
      for (int v = 0; v < V; ++v) {
        Vec<Real> sum{};
        for (int k = 0; k < z.taps; ++k) sum += Real(z.weight[i][k]) * in[z.start[i] + k - first][c][v];
        out[i - z.begin][c][v] = sum;
      }
}

template <class Real, int V>
void combine_p(const Axis& p, int rows, const Plane<Real, V>& in, Plane<Real, V>& out) {
  const int first = p.first_input();
  for (int r = 0; r < rows; ++r)
    for (int i = p.begin; i < p.end; ++i)
      for (int v = 0; v < V; ++v) {
        Vec<Real> sum{};
        for (int k = 0; k < p.taps; ++k) sum += Real(p.weight[i][k]) * in[r][p.start[i] + k - first][v];
        out[r][i - p.begin][v] = sum;
      }
}

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
  alignas(128) typename S::Real f[lanes];
  alignas(128) typename S::Element e[lanes];
  if (m < 4)
    store(f, v);
  else
    S::store(e, v);
  for (int i = 0; i < count; ++i) {
    std::byte* row = block + (cell[2] * n + cell[1] + i) * Layout::bytes;
    if (m < 4)
      Layout::macro(row, m)[cell[0]] = f[i];
    else
      Layout::stress(row, m)[cell[0]] = e[i];
  }
}

template <class S, int V>
[[gnu::flatten]] void run(const ResampleJob& job, const amr::Forest& forest, const SourceFields<S>& source,
                          double stress_factor, MomentField<S>& target) {
  using Real = typename S::Real;
  const bool x_lines = job.axis[0].inputs() > 4;
  const Axis &along = job.axis[x_lines ? 0 : 1], &p = job.axis[x_lines ? 1 : 0], &z = job.axis[2];
  const LineReader<S, V> reader(job, forest, source, along);
  const LaneCombination<Real, V> combine_lanes(along);
  const int p0 = p.first_input(), z0 = z.first_input(), rows = z.inputs(), columns = p.inputs();
  Plane<Real, V> in, half, out;
  for (int m = 0; m < moments; ++m) {
    for (int r = 0; r < rows; ++r)
      for (int c = 0; c < columns; ++c)
        in[r][c] = x_lines ? reader.along_x(m, p0 + c, z0 + r) : reader.along_y(m, p0 + c, z0 + r);
    if (z.outputs() < p.outputs()) {  // the axis that leaves less to do first
      combine_z<Real, V>(z, columns, in, half);
      combine_p<Real, V>(p, z.outputs(), half, out);
    } else {
      combine_p<Real, V>(p, rows, in, half);
      combine_z<Real, V>(z, p.outputs(), half, out);
    }
    const Real factor = m < 4 ? Real(1) : static_cast<Real>(stress_factor);
    for (int r = 0; r < z.outputs(); ++r)
      for (int c = 0; c < p.outputs(); ++c) {
        const Vec<Real> v = factor * combine_lanes(out[r][c]);
        const int zt = z.begin + r + job.shift[2];
        if (x_lines)
          write_along_x<S>(target.row(job.target, p.begin + c + job.shift[1], zt), m, along.begin + job.shift[0],
                           along.outputs(), v);
        else
          write_along_y<S>(target.block(job.target), m, {p.begin + c + job.shift[0], along.begin + job.shift[1], zt},
                           along.outputs(), v);
      }
  }
}

}  // namespace

int Axis::first_input() const { return *std::min_element(start.begin() + begin, start.begin() + end); }

int Axis::last_input() const { return *std::max_element(start.begin() + begin, start.begin() + end) + taps - 1; }

Axis cubic_axis(int begin, int end, int half, std::array<bool, 2> available) {
  Axis axis{begin, end, 4, {}, {}};
  const int low = available[0] ? -reach : 0, high = (available[1] ? n + reach : n) - axis.taps;
  for (int i = begin; i < end; ++i) {
    const int coarse = half * n / 2 + i / 2, odd = i & 1;
    axis.start[i] = std::clamp(coarse - 2 + odd, low, high);
    axis.weight[i] = cubic_weights(coarse + (odd ? 0.25 : -0.25) - axis.start[i]);
  }
  return axis;
}

Axis restriction_axis(int begin, int end) {
  Axis axis{begin, end, 5, {}, {}};
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
void resample(const ResampleJob& job, const amr::Forest& forest, const SourceFields<S>& source, double stress_factor,
              MomentField<S>& target) {
  const int longest = std::max(job.axis[0].inputs(), job.axis[1].inputs());
  if (longest <= lanes)
    run<S, 1>(job, forest, source, stress_factor, target);
  else
    run<S, 2>(job, forest, source, stress_factor, target);
}

#ifdef __F16C__
template void resample(const ResampleJob&, const amr::Forest&, const SourceFields<HalfStress>&, double,
                       MomentField<HalfStress>&);
#endif
template void resample(const ResampleJob&, const amr::Forest&, const SourceFields<FloatStress>&, double,
                       MomentField<FloatStress>&);
template void resample(const ResampleJob&, const amr::Forest&, const SourceFields<DoubleStress>&, double,
                       MomentField<DoubleStress>&);

}  // namespace drogue::lbm
