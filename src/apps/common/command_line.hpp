#pragma once

#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace relative_map {

/// A call that can't be carried out as it was written.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The words of a call: files, "--option VALUE" or "--option=VALUE", and "--flag"; after "--" all are files.
/// Everything throws UsageError, a sentence. Numbers may be negative; an option may be given once.
class CommandLine {
 public:
  /// `lists` are options of several values, "--list A B C", and may be given again.
  CommandLine(const std::vector<std::string>& words, const std::set<std::string>& options,
              const std::set<std::string>& flags = {}, const std::set<std::string>& lists = {});

  const std::vector<std::string>& files() const { return files_; }
  /// The files, if there are so many; `names` is for the sentence, e.g. "IN and OUT".
  const std::vector<std::string>& files(std::size_t least, std::size_t most, const std::string& names) const;
  bool has(const std::string& name) const { return values_.count(name) > 0; }
  std::string text(const std::string& option, const std::string& otherwise = "") const;
  double number(const std::string& option, double otherwise, double low, double high) const;
  /// Of a list; empty if it is not given.
  std::vector<std::string> texts(const std::string& list) const;
  std::vector<double> numbers(const std::string& list, std::size_t count, double low, double high) const;

 private:
  std::vector<std::string> files_;
  std::map<std::string, std::vector<std::string>> values_;
};

/// The whole of `text` as a finite number; UsageError names the option.
double parse_number(const std::string& option, const std::string& text);

/// "48.1,11.5[,520]" or such, `least` to `most` of them.
std::vector<double> parse_numbers(const std::string& option, const std::string& text, std::size_t least,
                                  std::size_t most);

bool asks_for_help(const std::string& word);

/// A tool's main: prints `usage` where any word asks for it, runs `run`, which gives the exit code, and says
/// each fault as "NAME: fault". A call that makes no sense gets the usage, too, and exit code 2; any other
/// fault gets `failed`.
int run_tool(const std::string& name, const char* usage, int argc, char** argv,
             int (*run)(const std::vector<std::string>& words), int failed = 1);

/// A bar on a terminal; silent elsewhere.
class ProgressBar {
 public:
  ProgressBar();
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  /// `done`: the share, [0, 1].
  void show(double done);

 private:
  bool shown_;
  int last_percent_ = -1;
};

}  // namespace relative_map
