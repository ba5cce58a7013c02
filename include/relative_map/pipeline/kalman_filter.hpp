#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cmath>

namespace relative_map::core {

/// A Kalman filter over `States` numbers (Kalman 1960; the covariance in Joseph's form, multiplied out, which
/// stays symmetric and positive whatever the gain). Models come with each call: linear ones, or the Jacobians
/// of others at the state, with the innovation taken from the full model (the extended filter).
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
    covariance_ = (f * covariance_ * f.transpose()).eval() + q;
  }

  /// Of a model that moves only the first states, the `Count` ones that `state`, F and Q are given for.
  template <int Count, class Transition, class Noise>
  void predict_first(const Eigen::Matrix<double, Count, 1>& state, const Eigen::MatrixBase<Transition>& f,
                     const Eigen::MatrixBase<Noise>& q) {
    state_.template head<Count>() = state;
    covariance_.template topRows<Count>() = (f * covariance_.template topRows<Count>()).eval();
    covariance_.template leftCols<Count>() = (covariance_.template leftCols<Count>() * f.transpose()).eval();
    covariance_.template topLeftCorner<Count, Count>() += q;
  }

  /// `innovation` is measured minus expected, H the Jacobian of what is expected, R the measurement's
  /// covariance; as many rows as there are measurements.
  template <class Innovation, class Jacobian, class Noise>
  void correct(const Eigen::MatrixBase<Innovation>& innovation, const Eigen::MatrixBase<Jacobian>& h,
               const Eigen::MatrixBase<Noise>& r) {
    constexpr int kRows = Jacobian::RowsAtCompileTime;
    const Eigen::Matrix<double, States, kRows> p_ht = covariance_ * h.transpose();
    const Eigen::Matrix<double, kRows, kRows> s = h * p_ht + r;
    const Eigen::Matrix<double, kRows, States> gain_transposed = s.llt().solve(p_ht.transpose());
    const Eigen::Matrix<double, States, kRows> gain = gain_transposed.transpose();
    state_ += gain * innovation;
    // (I - K H) P (I - K H)' + K R K'
    const Covariance p =
        covariance_ - gain * p_ht.transpose() - p_ht * gain.transpose() + gain * s * gain.transpose();
    covariance_ = 0.5 * (p + p.transpose());
  }

  /// How far an innovation is out of what is expected: squared, in standard deviations (Mahalanobis).
  template <class Innovation, class Jacobian, class Noise>
  double squared_distance(const Eigen::MatrixBase<Innovation>& innovation,
                          const Eigen::MatrixBase<Jacobian>& h, const Eigen::MatrixBase<Noise>& r) const {
    constexpr int kRows = Jacobian::RowsAtCompileTime;
    const Eigen::Matrix<double, kRows, kRows> s = h * covariance_ * h.transpose() + r;
    return innovation.dot(s.llt().solve(innovation));
  }

  /// To be put into another form: states that end, begin, or are known anew.
  State& state() { return state_; }
  Covariance& covariance() { return covariance_; }

 private:
  State state_ = State::Zero();
  Covariance covariance_ = Covariance::Zero();
};

}  // namespace relative_map::core
