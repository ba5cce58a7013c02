#pragma once

#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "relative_map/model/check_range.hpp"
#include "relative_map/ros/setup/parameters.hpp"

namespace relative_map {

/// Takes parameters by name, and keeps account of what was asked for and what was wrong.
class ParameterTaker {
 public:
  explicit ParameterTaker(const ParameterSet& parameters) : parameters_(parameters) {}

  void take(const std::string& name, double& value) {
    if (const Parameter* found = find(name)) {
      if (const double* number = std::get_if<double>(found)) {
        value = *number;
      } else if (const int* integer = std::get_if<int>(found)) {
        value = *integer;
      } else {
        faults.push_back(name + " must be a number");
      }
    }
  }
  void take(const std::string& name, bool& value) {
    if (const Parameter* found = find(name)) {
      if (const bool* flag = std::get_if<bool>(found)) {
        value = *flag;
      } else {
        faults.push_back(name + " must be true or false");
      }
    }
  }
  void take(const std::string& name, std::string& value) {
    if (const Parameter* found = find(name)) {
      if (const std::string* text = std::get_if<std::string>(found)) {
        value = *text;
      } else {
        faults.push_back(name + " must be text");
      }
    }
  }
  template <class Enum>
  void take(const std::string& name, Enum& value, const std::vector<std::pair<std::string, Enum>>& words) {
    std::string word;
    take(name, word);
    if (find(name) == nullptr || word.empty()) return;
    std::string choice;
    for (const auto& [known, meaning] : words) {
      if (word == known) {
        value = meaning;
        return;
      }
      choice += (choice.empty() ? "" : " or ") + known;
    }
    faults.push_back(name + " is '" + word + "', but must be " + choice);
  }
  void expect(const std::string& name, double value, double low, double high) {
    core::check_range(name, value, low, high, faults);
  }
  void add(const std::string& group, const std::vector<std::string>& found) {
    for (const std::string& fault : found) faults.push_back(group + "/" + fault);
  }
  /// Names what was not asked for, and throws std::runtime_error with all faults if there is any.
  void finish() {
    for (const auto& [name, value] : parameters_) {
      if (known_.count(name) == 0) faults.push_back(name + " is not a parameter of this node");
    }
    if (faults.empty()) return;
    std::string all = "bad parameters:";
    for (const std::string& fault : faults) all += "\n  " + fault;
    throw std::runtime_error(all);
  }

  std::vector<std::string> faults;

 private:
  const Parameter* find(const std::string& name) {
    known_.insert(name);
    const auto found = parameters_.find(name);
    return found == parameters_.end() ? nullptr : &found->second;
  }

  const ParameterSet& parameters_;
  std::set<std::string> known_;
};

}  // namespace relative_map
