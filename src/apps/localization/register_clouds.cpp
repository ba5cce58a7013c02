// Registers one cloud against another: where was the source's sensor in the target's frame?
#include <iostream>
#include <string>
#include <vector>

#include "command_line.hpp"
#include "registration.hpp"
#include "registration_output.hpp"

namespace relative_map {
namespace {

constexpr const char* kHelp =
    R"(Usage: rosrun relative_map register_clouds TARGET SOURCE [OPTION]...

Finds how the cloud SOURCE lies in the frame of the cloud TARGET: p_target = target_from_source * p_source.
Files: .pcd (ascii, binary, binary_compressed; metres) or KITTI's .bin (float32 x y z intensity).

  --method ndt|pyramid    ndt (default): normal distributions of the target's voxels, six degrees of freedom;
                          pyramid: cells of intensity and altitude on the ground; x, y and yaw are searched,
                          roll and pitch are the guess's, z comes from the ground
  --resolution M          [m] edge of a voxel (ndt, default 1.0, at least 0.5) or of a cell (pyramid, default 0.125)
  --leaf M                [m] voxel filter of the source (ndt, default 0.5; pyramid does without); 0: none.
                          The target is filtered with a fifth of it
  --near M, --far M       [m] points nearer or farther than that from their sensor are left out (default 1, 100).
                          --far 0: none is left out of the target, which may then be a map
  --guess X Y Z ROLL PITCH YAW
                          target_from_source to begin with: metres, and radians about fixed axes,
                          R = Rz(yaw) Ry(pitch) Rx(roll) (default: all 0)
  --max-correction M      [m] a result farther from the guess is not believed (default 3)
  --weigh fusion|intensity|altitude   what pyramid goes by (default fusion; where the target is too thin for its
                          intensity, altitude alone)
  --repeat N              times that it is done; the time is the median (default 1)
  --json                  one JSON object on standard output, with
    target_from_source    4 x 4, row by row; metres
    covariance            6 x 6 of x y z [m] and turns about the target's x y z axes [rad]
    score                 ndt: mean over the points of the sum over voxels, as in Magnusson (2009), larger is
                          better; pyramid: exp(-q / 2), q the mean squared distance of the cells
    likelihood, overlap   [0, 1] how well the points lie on the surfaces; share of points that meet the target
    upright_likelihood    [0, 1] the likelihood of the points that do not lie on the ground (ndt)
    condition             [-] information in the least known direction over that in the best known
    iterations            steps taken (pyramid: candidates looked at)
    ms                    CPU time of one alignment on one core, without reading, filtering and map building
    prepare_ms, map_ms    CPU time of filtering the clouds; of building the map
    converged, believed   true or false (pyramid: converged is always true)
    reasons, remarks      lists of sentences: why it is not believed; what else is worth knowing
    target_points, source_points   how many took part
Exit codes: 0 done (believed or not), 1 a file can't be read, 2 bad arguments.
)";

int run(const std::vector<std::string>& words) {
  const CommandLine line(
      words,
      {"--method", "--resolution", "--leaf", "--near", "--far", "--max-correction", "--repeat", "--weigh"},
      {"--json"}, {"--guess"});
  const std::vector<std::string>& files = line.files(2, 2, "TARGET and SOURCE");
  RegistrationRequest request;
  const std::string method = line.text("--method", "ndt");
  if (method != "ndt" && method != "pyramid") {
    throw UsageError("--method is '" + method + "', but must be ndt or pyramid");
  }
  request.pyramid = method == "pyramid";
  const std::string weigh = line.text("--weigh", "fusion");
  if (weigh == "intensity") {
    request.weighing = core::PyramidWeighing::kIntensity;
  } else if (weigh == "altitude") {
    request.weighing = core::PyramidWeighing::kAltitude;
  } else if (weigh != "fusion") {
    throw UsageError("--weigh is '" + weigh + "', but must be fusion, intensity or altitude");
  }
  request.resolution = request.pyramid ? line.number("--resolution", 0.125, 0.05, 1.0)
                                       : line.number("--resolution", 1.0, 0.5, 20.0);
  request.leaf = line.number("--leaf", 0.5, 0.0, 20.0);
  request.nearest = line.number("--near", 1.0, 0.0, 1e4);
  request.farthest = line.number("--far", 100.0, 0.0, 1e5);
  request.max_correction = line.number("--max-correction", 3.0, 0.0, 1e5);
  request.repeat = static_cast<int>(line.number("--repeat", 1.0, 1.0, 10000.0));
  const std::vector<double> guess = line.numbers("--guess", 6, -1e8, 1e8);
  if (!guess.empty()) request.guess = pose_of(guess);
  const core::PointCloud target = read_cloud(files[0]), source = read_cloud(files[1]);
  const Registration found = register_clouds(target, source, request);
  std::cout << (line.has("--json") ? json_of(found, request) : text_of(found, request)) << std::flush;
  return 0;
}

}  // namespace
}  // namespace relative_map

int main(int argc, char** argv) {
  return relative_map::run_tool("register_clouds", relative_map::kHelp, argc, argv, relative_map::run);
}
