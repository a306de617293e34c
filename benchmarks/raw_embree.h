#pragma once

#include <memory>
#include <vector>

#include "benchmarks/scenes.h"

namespace retrace::benchmarks {

/// Embree and nothing else on the same surface: no refinement, no exclusion of the source facet. The limit.
class RawEmbree {
 public:
  /// How the elements enter the hierarchy: as instances of the pieces they share, or as triangles of one mesh.
  enum class Build { instanced, flat };

  explicit RawEmbree(const Scene& scene, Build build = Build::instanced);
  ~RawEmbree();

  /// Each traces all rays in packets of 1, 8 or 16, or streams of 1024, and returns how many hit.
  std::size_t trace1(const std::vector<raytrace::SurfaceRay>& rays) const;
  std::size_t trace8(const std::vector<raytrace::SurfaceRay>& rays) const;
  std::size_t trace16(const std::vector<raytrace::SurfaceRay>& rays) const;
  std::size_t trace_streams(const std::vector<raytrace::SurfaceRay>& rays) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace retrace::benchmarks
