#include "relative_map/simulation/road_description.hpp"

#include <locale>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace relative_map::core {

namespace {

/// Reads from the classic locale, whatever the user's decimal point.
std::istringstream stream_of(const std::string& text) {
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  return stream;
}

/// The numbers that follow in `stream`; throws std::invalid_argument at anything else.
std::vector<double> numbers_in(std::istream& stream) {
  std::vector<double> numbers;
  double number = 0.0;
  while (stream >> number) numbers.push_back(number);
  if (!stream.eof()) throw std::invalid_argument("what follows the kind of piece must be numbers");
  return numbers;
}

void add_piece(const std::string& text, RoadShape& road) {
  std::istringstream stream = stream_of(text);
  std::string kind;
  stream >> kind;
  const std::vector<double> numbers = numbers_in(stream);
  const std::size_t n = numbers.size();
  if (kind == "straight" && n == 1) {
    road.add_straight(numbers[0]);
  } else if (kind == "arc" && n == 1) {
    road.add_arc(numbers[0]);
  } else if (kind == "arc" && n == 2) {
    road.add_arc(numbers[0], numbers[1]);
  } else if (kind == "clothoid" && n == 2) {
    road.add_clothoid(numbers[0], numbers[1]);
  } else if (kind == "clothoid" && n == 3) {
    road.add_clothoid(numbers[0], numbers[1], numbers[2]);
  } else {
    throw std::invalid_argument(
        "it is none of \"straight LENGTH\", \"arc LENGTH [KAPPA]\" and "
        "\"clothoid LENGTH [KAPPA_START] KAPPA_END\"");
  }
}

}  // namespace

RoadShape parse_road(const std::string& text, const Pose2& start) {
  if (text == "demo") return demo_road(start);
  if (text == "closed") return closed_road(start);
  RoadShape road(start);
  std::istringstream pieces(text);
  std::string piece;
  while (std::getline(pieces, piece, ';')) {
    const std::size_t first = piece.find_first_not_of(" \t\n");
    if (first == std::string::npos) continue;  // a trailing ';' does no harm
    piece = piece.substr(first, piece.find_last_not_of(" \t\n") + 1 - first);
    try {
      add_piece(piece, road);
    } catch (const std::invalid_argument& fault) {
      throw std::invalid_argument("the piece of road \"" + piece + "\" is faulty: " + fault.what());
    }
  }
  if (road.length() == 0.0) throw std::invalid_argument("the road has no pieces");
  return road;
}

}  // namespace relative_map::core
