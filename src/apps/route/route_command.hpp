#pragma once

#include <string>
#include <vector>

namespace relative_map {

/// The main of a command: help, exit codes (0 done, 1 failed, 2 bad arguments), faults as one sentence.
int run_command(int argc, char** argv, const std::string& name, const char* help,
                int (*run)(const std::vector<std::string>& words));

}  // namespace relative_map
