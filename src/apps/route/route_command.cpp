#include "route_command.hpp"

#include <exception>
#include <iostream>

#include "navigation_line_command.hpp"

namespace relative_map {

int run_command(int argc, char** argv, const std::string& name, const char* help,
                int (*run)(const std::vector<std::string>& words)) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  for (const std::string& word : words) {
    if (word != "--help" && word != "-h") continue;
    std::cout << help;
    return 0;
  }
  try {
    return run(words);
  } catch (const UsageError& fault) {
    std::cerr << name << ": " << fault.what() << "; see " << name << " --help\n";
    return 2;
  } catch (const std::exception& fault) {
    std::cerr << name << ": " << fault.what() << '\n';
    return 1;
  }
}

}  // namespace relative_map
