// SPDX-License-Identifier: GPL-3.0-or-later
#include "lbm/resample.hpp"

#include <algorithm>

namespace drogue::lbm {
namespace {

constexpr int n = amr::block_size;
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

template <class S>
const std::byte* line(const MomentField<S>& field, int id, int normal, int layer, int across) {
  if (normal == 0) return field.column(id, layer, across);
  return normal == 1 ? field.row(id, layer, across) : field.row(id, across, layer);
}

/// Lines of one layer of one block, by their place across.
struct Lines {
  const std::byte* first;
  std::ptrdiff_t stride;

  const std::byte* operator[](int i) const { return first + i * stride; }
};

/// The lines a job reads: [across][along][tap]; half-way through a step those of its end follow as further taps.
template <class S, int taps, bool midway>
class Source {
 public:
  static constexpr int terms = midway ? 2 * taps : taps;
  using Terms = std::array<std::array<const std::byte*, terms>, 2>;  // of one line: [along]

  Source(const ResampleJob& job, int first_layer, const amr::Forest& forest, const SourceFields<S>& fields) {
    for (int across = 0; across < 2; ++across)
      for (int along = 0; along < 2; ++along)
        for (int k = 0; k < taps; ++k) {
          const int layer = first_layer + k;
          const int id = job.source[layer / n * 4 + across * 2 + along];
          const bool parent = forest.block(id).kind == amr::Kind::parent;
          const auto lines = [&](const MomentField<S>& field) {
            const std::byte* first = line(field, id, job.normal, layer % n, 0);
            return Lines{first, line(field, id, job.normal, layer % n, 1) - first};
          };
          lines_[across][along][k] = lines(parent ? fields.parents : fields.leaves);
          if constexpr (midway) lines_[across][along][taps + k] = lines(parent ? fields.parents : *fields.leaves_end);
        }
  }

  Terms terms_of(int across) const {
    Terms p;
    for (int along = 0; along < 2; ++along)
      for (int k = 0; k < terms; ++k) p[along][k] = lines_[across / n][along][k][across % n];
    return p;
  }

  static void prefetch(const Terms& p) {
    for (const auto& line_terms : p)
      for (const std::byte* term : line_terms)
        for (std::size_t i = 0; i < RowLayout<S>::bytes; i += 64) __builtin_prefetch(term + i);
  }

 private:
  std::array<std::array<std::array<Lines, terms>, 2>, 2> lines_;
};

}  // namespace

Axis cubic_axis(int half, bool available) {
  Axis axis{interpolation_taps, {}, {}};
  // the coarse block comes second in the pair for the low half, first for the high one
  const int begin = half == 0 ? n : 0;
  const int low = half == 0 && available ? 0 : begin, high = half == 1 && available ? 2 * n : begin + n;
  for (int i = 0; i < n; ++i) {
    const int coarse = begin + half * n / 2 + i / 2, odd = i & 1;
    axis.start[i] = std::clamp(coarse - 2 + odd, low, high - axis.taps);
    axis.weight[i] = cubic_weights(coarse + (odd ? 0.25 : -0.25) - axis.start[i]);
  }
  return axis;
}

Axis restriction_axis() {
  Axis axis{restriction_taps, {}, {}};
  for (int i = 0; i < n; ++i) {
    const int child = i / (n / 2), j = i % (n / 2);
    const bool low = j < n / 4;
    // the centred four points stand in five taps, such that an end and the output next to it use the same
    axis.start[i] = child * n + std::clamp(2 * j - (low ? 2 : 1), 0, n - restriction_taps);
    if (low)
      axis.weight[i] = {0, -1, 9, 9, -1};
    else
      axis.weight[i] = {-1, 9, 9, -1, 0};
    if (j == 0) axis.weight[i] = {6, 11, 1, -3, 1};
    if (j == n / 2 - 1) axis.weight[i] = {1, -3, 1, 11, 6};
    for (double& w : axis.weight[i]) w /= 16.0;
  }
  return axis;
}

Axis axis_of_rule(int rule) { return rule == restriction_rule ? restriction_axis() : cubic_axis(rule / 2, rule % 2); }

template <class S>
Resampler<S>::Stencil::Stencil(const Axis& axis) : start(axis.start) {
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < Axis::most_taps; ++k) {
      weight[i][k] = lane_weight[k][i] = static_cast<Real>(axis.weight[i][k]);
      lane[k][i] = std::min(axis.start[i] + k, 2 * n - 1);
    }
}

template <class S>
Resampler<S>::Resampler(const amr::Forest& forest)
    : forest_(forest),
      stencil_{Stencil(axis_of_rule(0)), Stencil(axis_of_rule(1)), Stencil(axis_of_rule(2)), Stencil(axis_of_rule(3)),
               Stencil(axis_of_rule(restriction_rule))} {}

/// The normal axis is combined first, which leaves one or two layers, then lines along themselves, then across.
/// Flattened, or GCC 12 passes vectors through memory from call to call.
template <class S>
template <int taps, bool midway>
[[gnu::flatten]] void Resampler<S>::run(const ResampleJob& job, const SourceFields<S>& source,
                                        const Conversion& conversion, MomentField<S>& target) const {
  using Layout = RowLayout<S>;
  using V = Vec<Real>;
  constexpr int layers = taps == restriction_taps ? 2 : 1, most_lines = n;
  const Stencil &normal = stencil_[job.rule[0]], &across = stencil_[job.rule[1]], &along = stencil_[job.rule[2]];
  const Source<S, taps, midway> lines(job, normal.start[job.layers.begin], forest_, source);
  const int first = across.start[job.lines.begin], end = across.start[job.lines.end - 1] + taps;

  V combined[most_lines][moments][layers];
  for (int i = first; i < end; ++i) {
    const auto terms = lines.terms_of(i);
    lines.prefetch(lines.terms_of(std::min(i + 2, end - 1)));
    for (int m = 0; m < moments; ++m) {
      V sum[layers][2] = {};
      for (int side = 0; side < 2; ++side)
        for (int k = 0; k < lines.terms; ++k) {
          const V v = Layout::load_scaled(terms[side][k], m);
          for (int r = 0; r < layers; ++r) sum[r][side] += normal.weight[job.layers.begin + r][k % taps] * v;
        }
      for (int r = 0; r < layers; ++r) {
        V v = along.lane_weight[0] * pick<Real>(sum[r][0], sum[r][1], along.lane[0]);
        for (int k = 1; k < taps; ++k) v += along.lane_weight[k] * pick<Real>(sum[r][0], sum[r][1], along.lane[k]);
        combined[i - first][m][r] = v;
      }
    }
  }

  const Real time_weight = midway ? Real(0.5) : Real(1);
  const Real stress_weight = time_weight * static_cast<Real>(conversion.stress_factor);
  const IndexVec<Real> wanted = (lane_numbers<Real> >= job.cells.begin) & (lane_numbers<Real> < job.cells.end);
  const bool whole = job.cells.begin == 0 && job.cells.end == n;
  for (int r = 0; r < layers; ++r)
    for (int i = job.lines.begin; i < job.lines.end; ++i) {
      std::byte* to =
          const_cast<std::byte*>(line(std::as_const(target), job.target, job.normal, job.layers.begin + r, i));
      const auto* from = combined + across.start[i] - first;
      for (int m = 0; m < moments; ++m) {
        V v = across.weight[i][0] * from[0][m][r];
        for (int k = 1; k < taps; ++k) v += across.weight[i][k] * from[k][m][r];
        v *= m < 4 ? time_weight : stress_weight;
        if (m >= ux && m <= uz) v += static_cast<Real>(conversion.velocity_shift[m - ux]);
        Layout::store_scaled(to, m, whole ? v : wanted ? v : Layout::load_scaled(to, m));
      }
    }
}

template <class S>
void Resampler<S>::operator()(const ResampleJob& job, const SourceFields<S>& source, const Conversion& conversion,
                              MomentField<S>& target) const {
  if (job.rule[0] == restriction_rule)
    run<restriction_taps, false>(job, source, conversion, target);
  else if (source.leaves_end)
    run<interpolation_taps, true>(job, source, conversion, target);
  else
    run<interpolation_taps, false>(job, source, conversion, target);

  using Layout = RowLayout<S>;
  for (int layer = job.layers.begin; layer < job.layers.end; ++layer)
    for (int i = job.lines.begin; i < job.lines.end; ++i) {
      if (job.normal > 0) {  // the ends of rows, as columns
        const int y = job.normal == 1 ? layer : i, z = job.normal == 1 ? i : layer;
        target.for_each_column(job.target, [&](int x) {
          Layout::copy_element(target.row(job.target, y, z), x, target.column(job.target, x, z), y);
        });
      } else if (job.also_rows) {
        for (int y = job.cells.begin; y < job.cells.end; ++y)
          Layout::copy_element(target.column(job.target, layer, i), y, target.row(job.target, y, i), layer);
      }
    }
}

#ifdef __F16C__
template class Resampler<HalfStress>;
#endif
template class Resampler<FloatStress>;
template class Resampler<DoubleStress>;

}  // namespace drogue::lbm
