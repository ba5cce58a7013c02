#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace relative_map::core {

/// In which lane the vehicle is: a Bayes filter over its lateral offset from the current line's lane, on a
/// grid (Thrun, Burgard and Fox 2005, chapter 8). Several places stay possible until the evidence decides.
///
/// Odometry moves it, paint is the evidence. Localization says where to begin, and where the vehicle might be
/// after all: its errors last, so that each pose is no new witness. A vehicle drives in lanes: where there is
/// one line, in that line's.
class WhichLane {
 public:
  /// Lanes that have a line: the offsets of their centers from the current one's [m], left positive; and the
  /// half width of a lane with its standard deviation [m].
  struct Road {
    std::vector<double> centers{0.0};
    double half_width = 1.75;
    double half_width_stddev = 0.35;
  };
  /// One marker: how far to the left of the vehicle its paint is [m], negative on the right, square to the
  /// line.
  struct Seen {
    double offset;
    double stddev;
  };
  struct Place {
    double offset = 0.0;  ///< [m] of the vehicle from the current lane's center
    double stddev = 0.0;  ///< [m] within that lane
    double share = 0.0;   ///< [0, 1] of the belief that is there
  };

  explicit WhichLane(double localization_stddev) : localization_stddev_(localization_stddev) {}

  void reset() { started_ = false; }
  bool started() const { return started_; }
  /// `localized` [m]: the vehicle's offset from the current lane's center, as localization has it.
  void start(const Road& road, double localized);
  /// The vehicle has moved by `sideways` [m] to the left, known to `stddev` [m]; `localized` [m] as above.
  void move(double sideways, double stddev, double localized);
  /// Another line is the current one: its lane's center is `by` [m] to the left of the last one's.
  void change_line(double by) { origin_ -= by; }
  /// The nearest paint on either side; `seconds` since the last image.
  void see(const std::optional<Seen>& left, const std::optional<Seen>& right, double seconds,
           const Road& road);
  /// Where the vehicle most likely is.
  Place likeliest() const;
  /// The share of the belief that is near `offset` [m].
  double share_near(double offset) const;
  /// The share that has the vehicle at the same place as `place` within its lane, whichever lane with a line
  /// that is: the paint around the vehicle is the same then, only the lane's name is open.
  double share_alike(const Place& place, const Road& road) const;

 private:
  static constexpr int kCells = 361;
  static constexpr double kCell = 0.1;  ///< [m]
  using Belief = Eigen::Array<double, kCells, 1>;

  double offset_of(int cell) const { return origin_ + kCell * (cell - kCells / 2); }
  Belief prior(const Road& road, double localized) const;
  void spread(double variance);
  void recenter();

  double localization_stddev_;
  bool started_ = false;
  double origin_ = 0.0;     ///< [m] offset of the middle cell
  double localized_ = 0.0;  ///< [m] the newest
  double unspread_ = 0.0;   ///< [m^2] too little yet to be seen on the grid
  Belief belief_ = Belief::Zero();
};

}  // namespace relative_map::core
