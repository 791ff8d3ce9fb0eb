#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <optional>

#include "furrow_core/time.hpp"

namespace furrow::components {

/// Joins each colour image with the depth image of nearest stamp. The two come in either order and
/// with either delay; a camera that exposes them apart gives them stamps that differ. An image for
/// which no depth comes in time is handed out without one, so that nothing waits without end.
/// `Image` is held by shared pointers and not read.
template <class Image>
class FramePairing {
 public:
  using Pointer = std::shared_ptr<const Image>;

  /// Images of one kind that wait at most; the oldest goes first.
  static constexpr std::size_t kLimit = 4;

  /// Stamps of a pair differ by `tolerance` at most, which is to be below half the period between
  /// images. A colour image waits for `patience` after its arrival.
  FramePairing(Duration tolerance, Duration patience)
      : tolerance_(tolerance), patience_(patience) {}

  struct Frame {
    Pointer colour;
    Pointer depth;    ///< null: none came in time
    Duration offset;  ///< stamp of the depth less that of the colour
  };

  void add_colour(Time stamp, Time arrival, Pointer image) {
    colours_.push_back({stamp, arrival, std::move(image)});
  }
  void add_depth(Time stamp, Time arrival, Pointer image) {
    depths_.push_back({stamp, arrival, std::move(image)});
    if (depths_.size() > kLimit) depths_.pop_front();
  }

  /// The oldest frame that is settled by `now`: paired, waited for in vain, or pushed out by newer
  /// ones. Call until it returns nothing.
  [[nodiscard]] std::optional<Frame> next(Time now) {
    if (colours_.empty()) return std::nullopt;
    const Entry& colour = colours_.front();
    Frame frame{colour.image, nullptr, Duration()};
    if (const auto nearest = nearest_depth(colour.stamp); nearest != depths_.end()) {
      frame.depth = nearest->image;
      frame.offset = nearest->stamp - colour.stamp;
      depths_.erase(depths_.begin(), nearest + 1);
    } else if (now - colour.arrival < patience_ && colours_.size() <= kLimit) {
      return std::nullopt;
    }
    colours_.pop_front();
    return frame;
  }

 private:
  struct Entry {
    Time stamp;
    Time arrival;
    Pointer image;
  };

  /// Within the tolerance; else the end.
  [[nodiscard]] typename std::deque<Entry>::iterator nearest_depth(Time stamp) {
    auto nearest = depths_.end();
    for (auto depth = depths_.begin(); depth != depths_.end(); ++depth) {
      const Duration apart = distance(depth->stamp, stamp);
      if (apart > tolerance_) continue;
      if (nearest == depths_.end() || apart < distance(nearest->stamp, stamp)) nearest = depth;
    }
    return nearest;
  }
  static Duration distance(Time a, Time b) { return a < b ? b - a : a - b; }

  Duration tolerance_;
  Duration patience_;
  std::deque<Entry> colours_;
  std::deque<Entry> depths_;
};

}  // namespace furrow::components
