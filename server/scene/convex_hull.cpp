#include "scene/convex_hull.h"

#include <libqhull_r/libqhull_r.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <stdexcept>

namespace weft::scene {
namespace {

/// One run of Qhull. (Its C++ interface is not C++20.)
class Qhull {
 public:
  explicit Qhull(std::vector<Vec3> points) : points_(std::move(points)) {
    qh_zero(&qh_, silence_.get());
    char options[] = "qhull";
    // Facets that rounding alone keeps apart are merged, which is the default: of a box there are 6.
    failed_ = qh_new_qhull(&qh_, 3, static_cast<int>(points_.size()), points_.front().data(), False, options,
                           nullptr, silence_.get()) != 0;
  }
  ~Qhull() {
    int blocks = 0, bytes = 0;
    qh_freeqhull(&qh_, !qh_ALL);
    qh_memfreeshort(&qh_, &blocks, &bytes);
  }
  Qhull(const Qhull&) = delete;
  Qhull& operator=(const Qhull&) = delete;

  bool failed() const { return failed_; }
  /// Calls visit(corners) with the points at each facet's corners, counterclockwise as seen from outside.
  template <class Visit>
  void for_each_facet(Visit visit) {
    for (const facetT* facet = qh_.facet_list; facet != nullptr && facet->next != nullptr;
         facet = facet->next) {
      visit(corners_of(*facet));
    }
  }

 private:
  std::vector<int> corners_of(const facetT& facet) {
    struct Corner {
      int point;
      double angle;
    };
    std::vector<Corner> corners;
    Vec3 middle(0, 0, 0);
    for (const setelemT* element = facet.vertices->e; element->p != nullptr; ++element) {
      corners.push_back({qh_pointid(&qh_, static_cast<const vertexT*>(element->p)->point), 0});
      middle += place(corners.back().point);
    }
    middle /= static_cast<double>(corners.size());
    const Vec3 normal(facet.normal[0], facet.normal[1], facet.normal[2]);
    const Vec3 x = normal.unitOrthogonal(), y = normal.cross(x);
    for (Corner& corner : corners) {
      const Vec3 arm = place(corner.point) - middle;
      corner.angle = std::atan2(arm.dot(y), arm.dot(x));
    }
    std::sort(corners.begin(), corners.end(),
              [](const Corner& a, const Corner& b) { return a.angle < b.angle; });
    std::vector<int> result;
    result.reserve(corners.size());
    for (const Corner& corner : corners) result.push_back(corner.point);
    return result;
  }
  const Vec3& place(int point) const { return points_[static_cast<std::size_t>(point)]; }

  std::vector<Vec3> points_;
  /// Qhull writes down what it does not like.
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> silence_{std::fopen("/dev/null", "w"), &std::fclose};
  qhT qh_{};
  bool failed_ = false;
};

}  // namespace

TriangleList convex_hull(const std::vector<Vec3>& points) {
  TriangleList hull;
  hull.vertices = points;
  hull.convex = true;
  if (points.size() >= 4) {
    Qhull qhull(points);
    if (!qhull.failed()) {
      qhull.for_each_facet([&](const std::vector<int>& corners) {
        for (std::size_t i = 2; i < corners.size(); ++i) {
          hull.triangles.push_back({corners[0], corners[i - 1], corners[i]});
        }
      });
    }
  }
  if (hull.triangles.empty()) {
    throw std::invalid_argument("encloses no volume: it takes at least 4 points that are not in a plane");
  }
  return hull;
}

}  // namespace weft::scene
