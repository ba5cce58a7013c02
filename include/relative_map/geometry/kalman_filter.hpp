#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cmath>

namespace relative_map::core {

/// A Kalman filter over `States` numbers (Kalman 1960; the covariance in Joseph's form, multiplied out, which
/// stays symmetric and positive whatever the gain). Models come with each call: linear ones, or the Jacobians
/// of others at the state, with the innovation taken from the full model (the extended filter). Products are
/// Eigen's lazy ones: matrices are small, and its others pack their operands first.
template <int States>
class KalmanFilter {
 public:
  using State = Eigen::Matrix<double, States, 1>;
  using Covariance = Eigen::Matrix<double, States, States>;

  KalmanFilter() = default;
  KalmanFilter(const State& state, const Covariance& covariance) : state_(state), covariance_(covariance) {}

  const State& state() const { return state_; }
  const Covariance& covariance() const { return covariance_; }
  double stddev(int i) const { return std::sqrt(covariance_(i, i)); }
  /// False where numbers have run out of digits: nothing can be read from such a filter.
  bool sound() const {
    return state_.allFinite() && covariance_.allFinite() && covariance_.diagonal().minCoeff() >= 0.0;
  }

  /// x = F x, P = F P F' + Q.
  template <class Transition, class Noise>
  void predict(const Eigen::MatrixBase<Transition>& f, const Eigen::MatrixBase<Noise>& q) {
    predict_to(f * state_, f, q);
  }
  /// x = F x + B u, P = F P F' + Q.
  template <class Transition, class Control, class Input, class Noise>
  void predict(const Eigen::MatrixBase<Transition>& f, const Eigen::MatrixBase<Control>& b,
               const Eigen::MatrixBase<Input>& u, const Eigen::MatrixBase<Noise>& q) {
    predict_to(f * state_ + b * u, f, q);
  }
  /// Of a model that is not linear: `state` is what it makes of the state, F its Jacobian.
  template <class Transition, class Noise>
  void predict_to(const State& state, const Eigen::MatrixBase<Transition>& f,
                  const Eigen::MatrixBase<Noise>& q) {
    state_ = state;
    covariance_ = f.lazyProduct(covariance_).eval().lazyProduct(f.transpose()).eval() + q;
  }

  /// Of a model that moves only some states, the `Count` ones from `First` on, which F and Q are given for.
  template <int First, int Count, class Transition, class Noise>
  void predict_part(const Eigen::Matrix<double, Count, 1>& state, const Eigen::MatrixBase<Transition>& f,
                    const Eigen::MatrixBase<Noise>& q) {
    state_.template segment<Count>(First) = state;
    covariance_.template middleRows<Count>(First) =
        f.lazyProduct(covariance_.template middleRows<Count>(First)).eval();
    covariance_.template middleCols<Count>(First) =
        covariance_.template middleCols<Count>(First).lazyProduct(f.transpose()).eval();
    covariance_.template block<Count, Count>(First, First) += q;
  }

  /// What there is to expect of a measurement.
  template <int Rows>
  struct Expected {
    Eigen::Matrix<double, States, Rows> cross;     ///< covariance of state and measurement, P H'
    Eigen::Matrix<double, Rows, Rows> covariance;  ///< of the innovation, S = H P H' + R

    /// How far an innovation is out: squared, in standard deviations (Mahalanobis).
    double squared_distance(const Eigen::Matrix<double, Rows, 1>& innovation) const {
      return innovation.dot(covariance.llt().solve(innovation));
    }
  };
  /// H is the Jacobian of what is expected, R the measurement's covariance; as many rows as there are
  /// measurements.
  template <class Jacobian, class Noise>
  Expected<Jacobian::RowsAtCompileTime> expect(const Eigen::MatrixBase<Jacobian>& h,
                                               const Eigen::MatrixBase<Noise>& r) const {
    Expected<Jacobian::RowsAtCompileTime> expected;
    expected.cross = covariance_.lazyProduct(h.transpose());
    expected.covariance = h.lazyProduct(expected.cross) + r;
    return expected;
  }
  /// `innovation` is measured minus expected.
  template <int Rows>
  void correct(const Eigen::Matrix<double, Rows, 1>& innovation, const Expected<Rows>& expected) {
    const Eigen::Matrix<double, Rows, Rows>& s = expected.covariance;
    const Eigen::Matrix<double, Rows, Rows> inverse = s.llt().solve(s.Identity());
    const Eigen::Matrix<double, States, Rows> gain = expected.cross.lazyProduct(inverse);
    state_ += gain * innovation;
    // (I - K H) P (I - K H)' + K R K' = P - M K' - K M' with M = P H' - K S / 2.
    const Eigen::Matrix<double, States, Rows> m = expected.cross - 0.5 * gain.lazyProduct(s);
    const Covariance p = 0.5 * covariance_ - m.lazyProduct(gain.transpose());
    covariance_ = p + p.transpose();
  }

  /// To be put into another form: states that end, begin, or are known anew.
  State& state() { return state_; }
  Covariance& covariance() { return covariance_; }

 private:
  State state_ = State::Zero();
  Covariance covariance_ = Covariance::Zero();
};

}  // namespace relative_map::core
