// One tool for navigation lines, from a recorded drive to what the map node drives on.
#include <cstdio>
#include <cstring>
#include <iostream>

#include "navigation_line_command.hpp"

namespace relative_map {
namespace {

const std::vector<const Command*> kCommands = {&kRecord, &kCheck,   &kSmooth, &kConvert, &kResample, &kClose,
                                               &kOffset, &kReverse, &kCut,    &kJoin,    &kPublish};

constexpr const char* kIntroduction = R"(Usage: rosrun relative_map navigation_line SUBCOMMAND ...

From a drive to lanes, step by step:
  rosbag record -O drive.bag localization         # drive by hand
  navigation_line record drive.bag raw.smoothed   # the way that was driven
  navigation_line check raw.smoothed              # is it fit to be driven on?
  navigation_line smooth raw.smoothed lane.smoothed
  navigation_line offset lane.smoothed left.smoothed --distance 3.5
  navigation_line publish lane.smoothed left.smoothed

Subcommands; each explains itself with --help:
)";

constexpr const char* kFormats = R"(
Files are known by their extensions: .smoothed (one JSON object a line; also .jsonl, .txt), .json (all on one line),
.csv, .gpx, .geojson, .bag (nav_msgs/Path). A file is written whole or not at all. OUT must not be IN, unless --replace
says so (but for record), and no bag that holds anything else than a line.
Exit codes: 0 done, 1 failed or faults found, 2 bad arguments.
)";

void print_help() {
  std::cout << kIntroduction;
  for (const Command* command : kCommands) std::printf("  %-9s %s\n", command->name, command->summary);
  std::cout << kFormats;
}

bool asks_for_help(const std::string& word) {
  return word == "--help" || word == "-h" || word == "help";
}

int run(const std::vector<std::string>& words, const std::map<std::string, std::string>& remappings) {
  if (words.empty()) throw UsageError("a subcommand is needed; see navigation_line --help");
  if (asks_for_help(words[0])) {
    print_help();
    return 0;
  }
  for (const Command* command : kCommands) {
    if (words[0] != command->name) continue;
    const std::vector<std::string> rest(words.begin() + 1, words.end());
    for (const std::string& word : rest) {
      if (word != "--help" && word != "-h") continue;
      std::cout << command->help;
      return 0;
    }
    try {
      return command->run(rest, remappings);
    } catch (const UsageError& fault) {
      throw UsageError(std::string(command->name) + ": " + fault.what() + "; see navigation_line " +
                       command->name + " --help");
    } catch (const std::exception& fault) {
      throw std::runtime_error(std::string(command->name) + ": " + fault.what());
    }
  }
  throw UsageError("there is no subcommand '" + words[0] + "'; see navigation_line --help");
}

}  // namespace
}  // namespace relative_map

int main(int argc, char** argv) {
  std::vector<std::string> words;
  std::map<std::string, std::string> remappings;
  for (int i = 1; i < argc; ++i) {
    const char* const sign = std::strstr(argv[i], ":=");
    if (sign == nullptr) {
      words.emplace_back(argv[i]);
    } else {
      remappings[std::string(argv[i], static_cast<std::size_t>(sign - argv[i]))] = sign + 2;
    }
  }
  try {
    return relative_map::run(words, remappings);
  } catch (const relative_map::UsageError& fault) {
    std::cerr << "navigation_line: " << fault.what() << '\n';
    return 2;
  } catch (const std::exception& fault) {
    std::cerr << "navigation_line: " << fault.what() << '\n';
    return 1;
  }
}
