#pragma once

#include <Eigen/Core>
#include <string>
#include <variant>
#include <vector>

namespace relative_map::core {

/// A small feed-forward network, as training leaves it: a text file with the list of its features, their
/// means and deviations, its layers, and a golden input with the output that whoever trained it got. What
/// does not compute that output here is refused.
///
///   relative_map_network 1
///   features N name ...        in the order in which they are given
///   mean v ...                 N numbers
///   deviation v ...            N numbers above 0: a feature goes in as (value - mean) / deviation
///   dense IN OUT ACTIVATION    then OUT rows of IN weights and a bias
///   conv1d CHANNELS FILTERS KERNEL STRIDE ACTIVATION   then FILTERS rows of CHANNELS * KERNEL weights and a
///   bias; its
///                              input is CHANNELS rows of equal length one after the other, without padding
///   golden_input v ...         N numbers
///   golden_output v ...
///
/// ACTIVATION is linear, relu, tanh or sigmoid. '#' begins a comment.
class Network {
 public:
  /// Throws std::runtime_error, one sentence that begins with `name`, where the text is no such network,
  /// where its features are not `features` in that order, or where its golden pair does not hold (1e-4
  /// relative).
  static Network parse(const std::string& text, const std::string& name,
                       const std::vector<std::string>& features);

  /// `features` in their own units; as many as there are names.
  Eigen::VectorXd run(const Eigen::VectorXd& features) const;
  Eigen::Index outputs() const { return outputs_; }

 private:
  enum class Activation { kLinear, kRelu, kTanh, kSigmoid };
  struct Dense {
    Eigen::MatrixXd weights;  ///< outputs x inputs
    Eigen::VectorXd bias;
    Activation activation;
  };
  struct Conv1d {
    Eigen::MatrixXd weights;  ///< filters x (channels * kernel)
    Eigen::VectorXd bias;
    Eigen::Index channels, kernel, stride;
    Activation activation;
  };
  using Layer = std::variant<Dense, Conv1d>;
  friend class NetworkReader;

  static Eigen::VectorXd apply(const Dense& layer, const Eigen::VectorXd& input);
  static Eigen::VectorXd apply(const Conv1d& layer, const Eigen::VectorXd& input);
  static void activate(Activation activation, Eigen::VectorXd& values);

  Eigen::VectorXd mean_, deviation_;
  std::vector<Layer> layers_;
  Eigen::Index outputs_ = 0;
};

}  // namespace relative_map::core
