#include "command_line.hpp"

#include <unistd.h>

#include <algorithm>
#include <boost/program_options.hpp>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <sstream>

#include "relative_map/io/text.hpp"

namespace relative_map {

namespace {

namespace po = boost::program_options;

constexpr const char* kFiles = "files";  // no word can name it: options begin with "--"

/// Without the "--" that the library adds by itself.
const char* bare(const std::string& option) {
  return option.c_str() + 2;
}

po::options_description described(const std::set<std::string>& options, const std::set<std::string>& flags,
                                  const std::set<std::string>& lists) {
  po::options_description all;
  for (const std::string& option : options) all.add_options()(bare(option), po::value<std::string>(), "");
  for (const std::string& flag : flags) all.add_options()(bare(flag), "");
  for (const std::string& list : lists) {
    all.add_options()(bare(list), po::value<std::vector<std::string>>()->multitoken(), "");
  }
  all.add_options()(kFiles, po::value<std::vector<std::string>>(), "");
  return all;
}

std::string sentence_about(const po::invalid_command_line_syntax& fault) {
  const std::string name = fault.get_option_name();
  return fault.kind() == po::invalid_syntax::extra_parameter ? name + " takes no value"
                                                             : name + " needs a value";
}

double in_range(const std::string& option, const std::string& text, double low, double high) {
  const double number = parse_number(option, text);
  if (number >= low && number <= high) return number;
  std::ostringstream fault;
  fault << option << " is " << text << ", but must lie in [" << low << ", " << high << "]";
  throw UsageError(fault.str());
}

}  // namespace

CommandLine::CommandLine(const std::vector<std::string>& words, const std::set<std::string>& options,
                         const std::set<std::string>& flags, const std::set<std::string>& lists) {
  const auto end = std::find(words.begin(), words.end(), "--");
  const po::options_description known = described(options, flags, lists);
  po::positional_options_description positions;
  positions.add(kFiles, -1);
  // Whole names only, and no short ones: "-3.5" is a number.
  const int style = po::command_line_style::allow_long | po::command_line_style::long_allow_adjacent |
                    po::command_line_style::long_allow_next;
  try {
    po::variables_map values;
    po::store(po::command_line_parser(std::vector<std::string>(words.begin(), end))
                  .options(known)
                  .positional(positions)
                  .style(style)
                  .run(),
              values);
    for (const auto& [name, value] : values) {
      if (name == kFiles) {
        files_ = value.as<std::vector<std::string>>();
      } else if (lists.count("--" + name) > 0) {
        values_["--" + name] = value.as<std::vector<std::string>>();
      } else {
        values_["--" + name] = {flags.count("--" + name) > 0 ? "" : value.as<std::string>()};
      }
    }
  } catch (const po::unknown_option& fault) {
    throw UsageError("unknown option " + fault.get_option_name());
  } catch (const po::multiple_occurrences& fault) {
    throw UsageError(fault.get_option_name() + " is given more than once");
  } catch (const po::invalid_command_line_syntax& fault) {
    throw UsageError(sentence_about(fault));
  } catch (const po::error& fault) {
    throw UsageError(fault.what());
  }
  for (const std::string& file : files_) {
    if (file.size() > 1 && file[0] == '-') throw UsageError("unknown option " + file);
  }
  if (end != words.end()) files_.insert(files_.end(), end + 1, words.end());
}

const std::vector<std::string>& CommandLine::files(std::size_t least, std::size_t most,
                                                   const std::string& names) const {
  if (files_.size() < least) throw UsageError(names + " must be named");
  if (files_.size() > most) throw UsageError("unexpected argument '" + files_[most] + "'");
  return files_;
}

std::string CommandLine::text(const std::string& option, const std::string& otherwise) const {
  const auto found = values_.find(option);
  return found == values_.end() ? otherwise : found->second.front();
}

double CommandLine::number(const std::string& option, double otherwise, double low, double high) const {
  return has(option) ? in_range(option, text(option), low, high) : otherwise;
}

std::vector<std::string> CommandLine::texts(const std::string& list) const {
  const auto found = values_.find(list);
  return found == values_.end() ? std::vector<std::string>() : found->second;
}

std::vector<double> CommandLine::numbers(const std::string& list, std::size_t count, double low,
                                         double high) const {
  std::vector<double> numbers;
  if (!has(list)) return numbers;
  for (const std::string& word : values_.at(list)) numbers.push_back(in_range(list, word, low, high));
  if (numbers.size() == count) return numbers;
  throw UsageError(list + " needs " + std::to_string(count) + " numbers, and has " +
                   std::to_string(numbers.size()));
}

double parse_number(const std::string& option, const std::string& text) {
  const std::optional<double> number = core::parse_number(text);
  if (!number) throw UsageError(option + " must be a number, not '" + text + "'");
  return *number;
}

std::vector<double> parse_numbers(const std::string& option, const std::string& text, std::size_t least,
                                  std::size_t most) {
  std::vector<double> numbers;
  std::istringstream stream(text);
  for (std::string word; std::getline(stream, word, ',');) numbers.push_back(parse_number(option, word));
  if (numbers.size() >= least && numbers.size() <= most) return numbers;
  throw UsageError(option + " must be " + std::to_string(least) + " to " + std::to_string(most) +
                   " numbers with commas between them, not '" + text + "'");
}

bool asks_for_help(const std::string& word) {
  return word == "--help" || word == "-h";
}

int run_tool(const std::string& name, const char* usage, int argc, char** argv,
             int (*run)(const std::vector<std::string>& words), int failed) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (std::any_of(words.begin(), words.end(), asks_for_help)) {
    std::cout << usage;
    return 0;
  }
  try {
    return run(words);
  } catch (const UsageError& fault) {
    std::cerr << name << ": " << fault.what() << "\n\n" << usage;
    return 2;
  } catch (const std::exception& fault) {
    std::cerr << name << ": " << fault.what() << "\n";
    return failed;
  }
}

ProgressBar::ProgressBar() : shown_(isatty(STDERR_FILENO) != 0) {}

ProgressBar::~ProgressBar() {
  if (shown_ && last_percent_ >= 0) std::fputs("\n", stderr);
}

void ProgressBar::show(double done) {
  const int percent = static_cast<int>(100.0 * done);
  if (!shown_ || percent == last_percent_) return;
  last_percent_ = percent;
  const std::string bar(static_cast<std::size_t>(percent / 2), '#');
  std::fprintf(stderr, "\r[%-50s] %3d %%", bar.c_str(), percent);
}

}  // namespace relative_map
