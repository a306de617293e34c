#pragma once

#include <memory>
#include <vector>

#include "benchmarks/scenes.h"

namespace retrace::benchmarks {

/// Traces rays with Embree only, on the same back surface as the other benchmarks. Intersections are not refined in
/// double precision and the source facet is not excluded, so the time is a lower bound.
class RawEmbree {
 public:
  /// Structure of the Embree scene: instances of shared patches, or the triangles of a single mesh.
  enum class Build { instanced, flat };

  explicit RawEmbree(const Scene& scene, Build build = Build::instanced);
  ~RawEmbree();

  /// Each function traces all rays, in packets of 1, 8 or 16 or in streams of 1024. It returns the number of hits.
  std::size_t trace1(const std::vector<raytrace::SurfaceRay>& rays) const;
  std::size_t trace8(const std::vector<raytrace::SurfaceRay>& rays) const;
  std::size_t trace16(const std::vector<raytrace::SurfaceRay>& rays) const;
  std::size_t trace_streams(const std::vector<raytrace::SurfaceRay>& rays) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace retrace::benchmarks
