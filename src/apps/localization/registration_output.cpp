#include "registration_output.hpp"

#include <cmath>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>

namespace relative_map {

namespace {

template <class Matrix>
nlohmann::json rows_of(const Matrix& matrix) {
  nlohmann::json rows = nlohmann::json::array();
  for (Eigen::Index r = 0; r < matrix.rows(); ++r) {
    nlohmann::json row = nlohmann::json::array();
    for (Eigen::Index c = 0; c < matrix.cols(); ++c) row.push_back(matrix(r, c));
    rows.push_back(row);
  }
  return rows;
}

}  // namespace

std::string json_of(const Registration& found, const RegistrationRequest& request) {
  nlohmann::json json;
  json["method"] = request.pyramid ? "pyramid" : "ndt";
  json["resolution"] = request.resolution;
  json["target_from_source"] = rows_of(found.target_from_source.matrix());
  json["covariance"] = rows_of(found.covariance);
  json["score"] = found.score;
  json["likelihood"] = found.likelihood;
  json["upright_likelihood"] = found.upright_likelihood;
  json["overlap"] = found.overlap;
  json["condition"] = found.condition;
  json["iterations"] = found.iterations;
  json["ms"] = found.ms;
  json["prepare_ms"] = found.prepare_ms;
  json["map_ms"] = found.map_ms;
  json["converged"] = found.converged;
  json["believed"] = found.believed;
  json["reasons"] = found.reasons;
  json["remarks"] = found.remarks;
  json["target_points"] = found.target_points;
  json["source_points"] = found.source_points;
  return json.dump() + "\n";
}

std::string text_of(const Registration& found, const RegistrationRequest& request) {
  std::ostringstream text;
  text << "target_from_source [m]\n" << std::fixed << std::setprecision(6);
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 4; ++c) text << std::setw(14) << found.target_from_source.matrix()(r, c);
    text << '\n';
  }
  text << "covariance: x y z [m], turns about x y z [rad]\n" << std::scientific << std::setprecision(3);
  for (int r = 0; r < 6; ++r) {
    for (int c = 0; c < 6; ++c) text << std::setw(12) << found.covariance(r, c);
    text << '\n';
  }
  const auto sigma = [&](int i) { return std::sqrt(found.covariance(i, i)); };
  text << std::defaultfloat << std::setprecision(4) << "standard deviations: " << sigma(0) << " " << sigma(1)
       << " " << sigma(2) << " m, " << sigma(3) << " " << sigma(4) << " " << sigma(5) << " rad\n"
       << "score: " << found.score << ", likelihood " << found.likelihood << ", overlap " << found.overlap
       << ", condition " << found.condition << '\n'
       << "iterations: " << found.iterations << (found.converged ? ", converged" : ", not converged") << '\n'
       << "ms: " << found.ms
       << (request.repeat > 1 ? " (median of " + std::to_string(request.repeat) + ")" : "") << "; filtering "
       << found.prepare_ms << ", map " << found.map_ms << '\n'
       << "points: " << found.source_points << " of the source, " << found.target_points << " of the target\n"
       << "believed: " << (found.believed ? "yes" : "no") << '\n';
  for (const std::string& reason : found.reasons) text << "  " << reason << '\n';
  for (const std::string& remark : found.remarks) text << "  note: " << remark << '\n';
  return text.str();
}

}  // namespace relative_map
