#include "relative_map/prediction/network.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace relative_map::core {

namespace {

constexpr long kMost = 100000;       // of anything in a file: a network for a tick is small
constexpr double kTolerance = 1e-4;  // of the golden output, relative to 1 + its size: text has six digits

}  // namespace

/// Reads the text word by word; every fault ends it.
class NetworkReader {
 public:
  NetworkReader(const std::string& text, std::string name) : name_(std::move(name)) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) words_ << line.substr(0, line.find('#')) << '\n';
  }

  Network read(const std::vector<std::string>& features) {
    if (word("its first word") != "relative_map_network" || word("its version") != "1") {
      fail("it is no text of relative_map_network 1");
    }
    expect("features");
    const long count = number_of("features");
    for (long i = 0; i < count; ++i) {
      const std::string feature = word("a feature");
      if (i >= static_cast<long>(features.size()) || features[static_cast<std::size_t>(i)] != feature) {
        fail("its feature " + std::to_string(i + 1) + " is '" + feature +
             "', which is not what is given there");
      }
    }
    if (count != static_cast<long>(features.size())) {
      fail("it has " + std::to_string(count) + " features, and " + std::to_string(features.size()) +
           " are given");
    }
    Network network;
    expect("mean");
    network.mean_ = vector(count, "mean");
    expect("deviation");
    network.deviation_ = vector(count, "deviation");
    if ((network.deviation_.array() <= 0.0).any()) fail("a deviation is not above 0");
    Eigen::Index size = count;
    std::string kind = word("a layer");
    for (; kind == "dense" || kind == "conv1d"; kind = word("a layer or golden_input")) {
      network.layers_.push_back(kind == "dense" ? dense(size) : conv1d(size));
    }
    if (network.layers_.empty()) fail("it has no layer");
    network.outputs_ = size;
    if (kind != "golden_input") fail("there is '" + kind + "' where a layer or golden_input is due");
    const Eigen::VectorXd input = vector(count, "golden_input");
    expect("golden_output");
    const Eigen::VectorXd output = vector(size, "golden_output");
    if (std::string rest; words_ >> rest) fail("there is '" + rest + "' after its end");
    const Eigen::VectorXd computed = network.run(input);
    const double off = (computed - output).cwiseAbs().maxCoeff();
    if (!(off <= kTolerance * (1.0 + output.cwiseAbs().maxCoeff()))) {
      fail("its golden input gives something else here, off by " + std::to_string(off));
    }
    return network;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error(name_ + ": the network is refused: " + what);
  }
  std::string word(const std::string& what) {
    std::string word;
    if (!(words_ >> word)) fail("it ends where " + what + " is due");
    return word;
  }
  void expect(const std::string& due) {
    const std::string found = word(due);
    if (found != due) fail("there is '" + found + "' where " + due + " is due");
  }
  double real(const std::string& what) {
    const std::string text = word(what);
    std::size_t used = 0;
    double value = std::nan("");
    try {
      value = std::stod(text, &used);
    } catch (const std::exception&) {
    }
    if (used != text.size() || !std::isfinite(value)) fail("'" + text + "' in " + what + " is no number");
    return value;
  }
  long number_of(const std::string& what) {
    const double value = real("the number of " + what);
    if (!(value >= 1.0 && value <= kMost && value == std::floor(value)))
      fail("the number of " + what + " is not fit");
    return static_cast<long>(value);
  }
  Eigen::VectorXd vector(Eigen::Index size, const std::string& what) {
    Eigen::VectorXd values(size);
    for (Eigen::Index i = 0; i < size; ++i) values[i] = real(what);
    return values;
  }
  Network::Activation activation() {
    const std::string name = word("an activation");
    if (name == "linear") return Network::Activation::kLinear;
    if (name == "relu") return Network::Activation::kRelu;
    if (name == "tanh") return Network::Activation::kTanh;
    if (name == "sigmoid") return Network::Activation::kSigmoid;
    fail("'" + name + "' is no activation");
  }
  /// Rows of weights, each with its bias at the end.
  template <class Layer>
  void weights(Layer& layer, Eigen::Index rows, Eigen::Index columns) {
    if (rows * columns > kMost) fail("a layer has more than " + std::to_string(kMost) + " weights");
    layer.weights.resize(rows, columns);
    layer.bias.resize(rows);
    for (Eigen::Index row = 0; row < rows; ++row) {
      layer.weights.row(row) = vector(columns, "weights").transpose();
      layer.bias[row] = real("a bias");
    }
  }
  Network::Layer dense(Eigen::Index& size) {
    Network::Dense layer;
    const Eigen::Index inputs = number_of("inputs"), outputs = number_of("outputs");
    layer.activation = activation();
    if (inputs != size) {
      fail("a dense layer takes " + std::to_string(inputs) + " values, and gets " + std::to_string(size));
    }
    weights(layer, outputs, inputs);
    size = outputs;
    return layer;
  }
  Network::Layer conv1d(Eigen::Index& size) {
    Network::Conv1d layer;
    layer.channels = number_of("channels");
    const Eigen::Index filters = number_of("filters");
    layer.kernel = number_of("values in the kernel");
    layer.stride = number_of("steps in the stride");
    layer.activation = activation();
    const Eigen::Index length = size / layer.channels;
    if (length * layer.channels != size || length < layer.kernel) {
      fail("a conv1d layer of " + std::to_string(layer.channels) + " channels gets " + std::to_string(size) +
           " values");
    }
    weights(layer, filters, layer.channels * layer.kernel);
    size = filters * ((length - layer.kernel) / layer.stride + 1);
    return layer;
  }

  std::string name_;
  std::stringstream words_;
};

Network Network::parse(const std::string& text, const std::string& name,
                       const std::vector<std::string>& features) {
  return NetworkReader(text, name).read(features);
}

void Network::activate(Activation activation, Eigen::VectorXd& values) {
  switch (activation) {
    case Activation::kRelu:
      values = values.cwiseMax(0.0);
      break;
    case Activation::kTanh:
      values = values.array().tanh();
      break;
    case Activation::kSigmoid:
      values = 1.0 / (1.0 + (-values.array()).exp());
      break;
    case Activation::kLinear:
      break;
  }
}

Eigen::VectorXd Network::apply(const Dense& layer, const Eigen::VectorXd& input) {
  Eigen::VectorXd output = layer.weights * input + layer.bias;
  activate(layer.activation, output);
  return output;
}

Eigen::VectorXd Network::apply(const Conv1d& layer, const Eigen::VectorXd& input) {
  const Eigen::Index length = input.size() / layer.channels;
  const Eigen::Index places = (length - layer.kernel) / layer.stride + 1;
  Eigen::VectorXd output(layer.weights.rows() * places);
  Eigen::VectorXd window(layer.channels * layer.kernel);
  for (Eigen::Index place = 0; place < places; ++place) {
    for (Eigen::Index channel = 0; channel < layer.channels; ++channel) {
      window.segment(channel * layer.kernel, layer.kernel) =
          input.segment(channel * length + place * layer.stride, layer.kernel);
    }
    const Eigen::VectorXd values = layer.weights * window + layer.bias;
    for (Eigen::Index filter = 0; filter < values.size(); ++filter)
      output[filter * places + place] = values[filter];
  }
  activate(layer.activation, output);
  return output;
}

Eigen::VectorXd Network::run(const Eigen::VectorXd& features) const {
  Eigen::VectorXd values = (features - mean_).cwiseQuotient(deviation_);
  for (const Layer& layer : layers_) {
    values = std::visit([&](const auto& kind) { return apply(kind, values); }, layer);
  }
  return values;
}

}  // namespace relative_map::core
