// SPDX-License-Identifier: GPL-3.0-or-later
// Which points are near which faces, against brute force, while they move.
#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>

#include "bodies.hpp"
#include "fem/contact_search.hpp"

namespace drogue::fem {
namespace {

constexpr double gap = 1.0;

/// Two square sheets, of quadrilaterals and of triangles.
struct Sheets {
  std::vector<Vec3> place;
  std::vector<ContactFace> faces;
  ContactGraph graph;
  std::size_t second = 0;  ///< the first point of the second one

  /// `width`: of a cell.
  explicit Sheets(double width) {
    const double side = 5 * width;
    for (const bool triangles : {false, true}) {
      second = place.size();
      const int first = static_cast<int>(second);
      const Mesh mesh =
          make_sheet({{Vec3(0, 0, 0), Vec3(side, 0, 0), Vec3(side, side, 0), Vec3(0, side, 0)}, {5, 5}, triangles});
      place.insert(place.end(), mesh.nodes.begin(), mesh.nodes.end());
      for (const auto& [a, b, c, d] : mesh.quadrilaterals)
        faces.push_back({{first + a, first + b, first + c, first + d}});
      for (const auto& [a, b, c] : mesh.triangles) faces.push_back({{first + a, first + b, first + c, -1}});
    }
    graph.resize(place.size());
    for (const ContactFace& face : faces) {
      for (int k = 0; k < face.corners(); ++k) {
        for (int l = 0; l < face.corners(); ++l) {
          const int a = face.point[k], b = face.point[l];
          if (a != b) graph[a].emplace_back(b, (place[a] - place[b]).norm());
        }
      }
    }
  }
};

using Table = std::vector<std::vector<bool>>;  ///< [point][point]

/// Which points are too near along the surface to see each other, by Floyd and Warshall.
Table neighbours(const ContactGraph& graph) {
  const std::size_t count = graph.size();
  std::vector<std::vector<double>> way(count, std::vector<double>(count, INFINITY));
  for (std::size_t a = 0; a < count; ++a) {
    way[a][a] = 0.0;
    for (const auto& [b, length] : graph[a]) way[a][b] = length;
  }
  for (std::size_t via = 0; via < count; ++via) {
    for (std::size_t a = 0; a < count; ++a) {
      for (std::size_t b = 0; b < count; ++b) way[a][b] = std::min(way[a][b], way[a][via] + way[via][b]);
    }
  }
  Table near(count, std::vector<bool>(count));
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t b = 0; b < count; ++b) near[a][b] = way[a][b] <= 1.5 * gap;
    for (const auto& [b, length] : graph[a]) near[a][b] = true;
  }
  return near;
}

double distance(const Vec3& p, const std::array<Vec3, 3>& triangle) {
  const Vec3 normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
  bool inside = true;
  double to_edge = INFINITY;
  for (int k = 0; k < 3; ++k) {
    const Vec3 edge = triangle[(k + 1) % 3] - triangle[k], from = p - triangle[k];
    inside = inside && normal.cross(edge).dot(from) >= 0.0;
    to_edge = std::min(to_edge, (from - std::clamp(from.dot(edge) / edge.squaredNorm(), 0.0, 1.0) * edge).norm());
  }
  return inside ? std::abs(normal.dot(p - triangle[0])) / normal.norm() : to_edge;
}

double distance(int point, const ContactFace& face, const std::vector<Vec3>& place) {
  double nearest = INFINITY;
  for (int half = 0; half < face.corners() - 2; ++half) {
    nearest = std::min(nearest, distance(place[point], {place[face.point[0]], place[face.point[half + 1]],
                                                        place[face.point[half + 2]]}));
  }
  return nearest;
}

using Pairs = std::vector<std::array<int, 2>>;  ///< {point, face}, ascending

bool is_neighbour(int point, const ContactFace& face, const Table& neighbours) {
  return std::any_of(face.point.begin(), face.point.begin() + face.corners(),
                     [&](int corner) { return neighbours[point][corner]; });
}

Pairs nearer_than_the_gap(const Sheets& sheets, const Table& neighbours) {
  Pairs pairs;
  for (int point = 0; point < static_cast<int>(sheets.place.size()); ++point) {
    for (int face = 0; face < static_cast<int>(sheets.faces.size()); ++face) {
      if (is_neighbour(point, sheets.faces[face], neighbours)) continue;
      if (distance(point, sheets.faces[face], sheets.place) < gap) pairs.push_back({point, face});
    }
  }
  return pairs;
}

/// Those that may be nearer than the gap for all that the search knows.
Pairs to_look_at(const ContactSearch& search) {
  Pairs pairs;
  for (const auto& seeker : search.seekers()) {
    if (seeker.distance >= gap + search.approach()) continue;
    for (int k = seeker.first; k < seeker.last; ++k) pairs.push_back({seeker.point, search.near_faces()[k]});
  }
  return pairs;
}

/// Leads sheets, again and again, straight to somewhere else near each other, crumpled otherwise; `action` follows each
/// step. In four steps points come nearer to each other by less than a quarter of the gap, the least margin of a list.
template <class Action>
void wander(Sheets& sheets, const Action& action) {
  const std::vector<Vec3> flat = sheets.place;
  for (unsigned leg = 0; leg < 20; ++leg) {
    const auto shift = random_vectors(2, 3.0 * gap, 2 * leg),
               crumple = random_vectors(flat.size(), 0.3 * gap, 2 * leg + 1);
    std::vector<Vec3> way;
    for (std::size_t i = 0; i < flat.size(); ++i) {
      way.push_back(flat[i] + shift[i < sheets.second ? 0 : 1] + crumple[i] - sheets.place[i]);
    }
    const int steps = static_cast<int>(largest_norm(way) / (0.03 * gap)) + 1;
    for (int step = 0; step < steps; ++step) {
      for (std::size_t i = 0; i < way.size(); ++i) sheets.place[i] += way[i] / steps;
      action();
    }
  }
}

/// Calls `action` with what the search has at each step of wandering; it watches every fourth one. Returns how often it
/// sought anew.
template <class Action>
int follow(Sheets& sheets, const Action& action) {
  ContactSearch search(sheets.faces, sheets.graph, sheets.place, gap);
  int step = 0, found = 0;
  wander(sheets, [&] {
    if (step++ % 4 == 0) {
#pragma omp parallel
      search.watch([&](int point) { return sheets.place[point]; });
    }
    if (search.is_outdated()) {
#pragma omp parallel
      search.find(sheets.place);
      ++found;
    }
    action(to_look_at(search));
  });
  return found;
}

class ContactSearchOf : public ::testing::TestWithParam<double> {};

INSTANTIATE_TEST_SUITE_P(Faces, ContactSearchOf, ::testing::Values(0.7, 3.0), [](const auto& test) {
  return test.param < 1.0 ? "finer_than_the_gap" : "wider_than_the_gap";
});

TEST_P(ContactSearchOf, misses_nothing_between_two_lists_and_no_neighbours_are_in_them) {
  Sheets sheets(GetParam());
  const Table neighbours_of = neighbours(sheets.graph);
  int steps = 0;
  std::ptrdiff_t near = 0, looked_at = 0;
  Pairs missed;
  const int lists = follow(sheets, [&](const Pairs& pairs) {
    const Pairs expected = nearer_than_the_gap(sheets, neighbours_of);
    std::ranges::set_difference(expected, pairs, std::back_inserter(missed));
    for (const auto& [point, face] : pairs) EXPECT_FALSE(is_neighbour(point, sheets.faces[face], neighbours_of));
    ++steps;
    near += std::ssize(expected);
    looked_at += std::ssize(pairs);
  });
  std::printf("%d steps, %d lists, %td pairs near, %td looked at, %zu missed\n", steps, lists, near, looked_at,
              missed.size());
  EXPECT_TRUE(missed.empty());
  EXPECT_GT(near, 10 * steps);
  EXPECT_LT(lists, steps / 8);
}

TEST_P(ContactSearchOf, finds_the_same_for_any_number_of_threads) {
  const int threads = omp_get_max_threads();
  std::array<std::vector<Pairs>, 3> all;
  for (int k = 0; k < 3; ++k) {
    omp_set_num_threads(1 << k);
    Sheets sheets(GetParam());
    follow(sheets, [&](const Pairs& pairs) { all[k].push_back(pairs); });
  }
  omp_set_num_threads(threads);
  EXPECT_EQ(all[1], all[0]);
  EXPECT_EQ(all[2], all[0]);
}

}  // namespace
}  // namespace drogue::fem
