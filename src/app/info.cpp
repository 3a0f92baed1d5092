// SPDX-License-Identifier: GPL-3.0-or-later
#include <H5public.h>
#include <fmt/format.h>
#include <omp.h>
#include <spdlog/version.h>
#include <toml++/toml.h>

#include <Eigen/Core>
#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "amr/forest.hpp"
#include "app/inspect.hpp"
#include "app/version.hpp"

namespace drogue::app {

namespace {

std::string tuned_for() {
#if defined(__AVX512F__)
  return "AVX-512";
#elif defined(__AVX2__)
  return "AVX2";
#elif defined(__x86_64__)
  return "any x86-64";
#else
  return "this architecture";
#endif
}

std::string build_kind() {
#if defined(__SANITIZE_ADDRESS__)
  return "with sanitizers";
#elif defined(__OPTIMIZE__)
  return "optimised";
#else
  return "not optimised";
#endif
}

}  // namespace

std::string processor_name() {
  std::ifstream stream("/proc/cpuinfo");
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

std::string build_info() {
  std::string text = fmt::format("drogue     {}\n", version);
  text += fmt::format("compiler   GCC-compatible {}, {}, for {}\n", __VERSION__, build_kind(), tuned_for());
  text += fmt::format("processor  {}, {} threads\n", processor_name(), omp_get_max_threads());
  text += fmt::format(
      "libraries  p4est {}, HDF5 {}.{}.{}, Eigen {}.{}.{}, toml++ {}.{}.{}, spdlog {}.{}.{}, fmt {}.{}.{}, "
      "nlohmann-json {}.{}.{}\n",
      amr::octree_library_version(), H5_VERS_MAJOR, H5_VERS_MINOR, H5_VERS_RELEASE, EIGEN_WORLD_VERSION,
      EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION, TOML_LIB_MAJOR, TOML_LIB_MINOR, TOML_LIB_PATCH, SPDLOG_VER_MAJOR,
      SPDLOG_VER_MINOR, SPDLOG_VER_PATCH, FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100,
      NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH);
  return text;
}

}  // namespace drogue::app
