#include <algorithm>
#include <limits>

#include "doctor_rules.hpp"

// How often messages come, and when they say that they were made.
namespace relative_map::doctor {

namespace {

constexpr double kTolerance = 0.9;         // of a rate: clocks and schedulers jitter
constexpr double kMaxLead = 0.1;           // [s] more than clocks of well-kept machines differ
constexpr double kRecordedEarlier = 60.0;  // [s] nothing that runs now is so late

/// One message: when it came, and its stamp.
struct Instant {
  ros::Time at, stamp;
};

/// [s] Exact, and of any size: ros::Duration holds 68 years, and throws where a stamp is scrap.
double seconds_between(const ros::Time& from, const ros::Time& to) {
  return 1e-9 * static_cast<double>(static_cast<std::int64_t>(to.toNSec() - from.toNSec()));
}

/// An input that has to come in regularly.
struct Stream {
  std::string name;
  std::vector<Instant> instants;
  double max_age;   ///< [s] the node does not use older messages
  double min_rate;  ///< [Hz]
};

template <class Message>
Stream make_stream(const Input<Message>& input, double max_age, double min_rate) {
  Stream stream{input.topic.name, {}, max_age, min_rate};
  for (const auto& [at, message] : input.messages) stream.instants.push_back({at, message->header.stamp});
  return stream;
}

/// Those of which messages came.
std::vector<Stream> streams(const Observations& seen) {
  const core::MaxAgeParam& max_age = seen.config.pipeline.max_age;
  std::vector<Stream> all = {make_stream(seen.localization, max_age.localization, 10.0),
                             make_stream(seen.chassis, max_age.chassis, 10.0),
                             make_stream(seen.lane_markers, max_age.lane_markers, 5.0)};
  all.erase(std::remove_if(all.begin(), all.end(), [](const Stream& s) { return s.instants.empty(); }),
            all.end());
  return all;
}

/// [Hz] Up to the last message; up to the end of listening if one is overdue by then, so that a publisher
/// that has died counts too.
double rate_of(const std::vector<Instant>& instants, const ros::Time& end) {
  const auto periods = static_cast<double>(instants.size() - 1);
  const double seconds = seconds_between(instants.front().at, instants.back().at);
  const double silence = seconds_between(instants.back().at, end);
  if (periods * silence <= 2.0 * seconds && seconds > 0.0) return periods / seconds;
  return seconds + silence > 0.0 ? periods / (seconds + silence) : 0.0;
}

/// Median of how long stamps lie before receipt [s]; NaN if no stamp is filled.
double age_of(const Stream& stream) {
  std::vector<double> ages;
  for (const Instant& instant : stream.instants) {
    if (!instant.stamp.isZero()) ages.push_back(seconds_between(instant.stamp, instant.at));
  }
  return median(ages);
}

bool clock_stands(const Observations& seen) {
  return seconds_between(seen.begin, seen.end) < 0.05 * seen.listened;
}

std::string on_clocks(const Observations& seen) {
  return seen.simulated_time
             ? "stamp messages with ros::Time::now(): /use_sim_time is true, so that /clock is the time"
             : "if the publisher runs on another machine, synchronize the clocks (chrony, PTP); else stamp "
               "with the time of measurement by this machine's clock";
}

}  // namespace

Findings clock_runs(const Evidence& evidence) {
  if (!evidence.seen.simulated_time) return {};
  if (!clock_stands(evidence.seen)) return {ok("/use_sim_time is true, and /clock runs")};
  return {
      wrong("/use_sim_time is true, but /clock " +
                std::string(evidence.seen.end.isZero() ? "has never come" : "stands still"),
            "start what publishes /clock (rosbag play --clock, a simulator) and let it run, or rosparam set "
            "/use_sim_time false and start all nodes again")};
}

Findings rates_are_high_enough(const Evidence& evidence) {
  if (clock_stands(evidence.seen)) return {};
  Findings findings;
  for (const Stream& stream : streams(evidence.seen)) {
    const double rate = rate_of(stream.instants, evidence.seen.end);
    const std::string what = stream.name + " comes " + fixed(rate, 1) + " times a second";
    if (rate >= kTolerance * stream.min_rate) {
      findings.push_back(ok(what));
    } else {
      findings.push_back(wrong(what + "; it should come " + fixed(stream.min_rate, 0) + " times or more",
                               "raise the rate of its publisher (if that is high enough, the machine or the "
                               "network is overloaded)"));
    }
  }
  return findings;
}

Findings inputs_do_not_pause(const Evidence& evidence) {
  if (clock_stands(evidence.seen)) return {};
  Findings findings;
  for (const Stream& stream : streams(evidence.seen)) {
    double longest = seconds_between(stream.instants.back().at, evidence.seen.end);
    for (std::size_t i = 1; i < stream.instants.size(); ++i) {
      longest = std::max(longest, seconds_between(stream.instants[i - 1].at, stream.instants[i].at));
    }
    if (longest <= stream.max_age) continue;
    findings.push_back(
        wrong(stream.name + " paused for " + fixed(longest, 1) + " s; after " + fixed(stream.max_age, 1) +
                  " s without a message the map node does not use the last one any more",
              "find out why its publisher stops now and then (sensor drop-outs, an overloaded machine)"));
  }
  return findings;
}

Findings stamps_are_filled(const Evidence& evidence) {
  Findings findings;
  for (const Stream& stream : streams(evidence.seen)) {
    const auto zeros = std::count_if(stream.instants.begin(), stream.instants.end(),
                                     [](const Instant& instant) { return instant.stamp.isZero(); });
    if (zeros == 0) continue;
    findings.push_back(wrong(
        text(stream.name, ": header.stamp is 0 in ", zeros, " of ", stream.instants.size(), " messages"),
        "fill header.stamp with the time of measurement"));
  }
  return findings;
}

Findings stamps_are_fresh(const Evidence& evidence) {
  if (clock_stands(evidence.seen)) return {};
  Findings findings;
  for (const Stream& stream : streams(evidence.seen)) {
    const double age = age_of(stream);
    if (std::isnan(age) || age < -kMaxLead) continue;
    if (age <= stream.max_age) {
      findings.push_back(ok(stream.name + " is " + fixed(1e3 * age, 0) + " ms old when it comes"));
      continue;
    }
    findings.push_back(wrong(
        stream.name + ": header.stamp is " + fixed(age, 1) + " s old when the message comes; more than " +
            fixed(stream.max_age, 1) + " s is not used",
        age > kRecordedEarlier && !evidence.seen.simulated_time
            ? "if a bag is played, rosparam set /use_sim_time true before the nodes start, and rosbag play "
              "--clock; else " +
                  on_clocks(evidence.seen)
            : on_clocks(evidence.seen)));
  }
  return findings;
}

Findings stamps_are_not_ahead(const Evidence& evidence) {
  if (clock_stands(evidence.seen)) return {};
  Findings findings;
  for (const Stream& stream : streams(evidence.seen)) {
    const double lead = -age_of(stream);
    if (!(lead > kMaxLead)) continue;
    findings.push_back(wrong(
        stream.name + ": header.stamp lies " + fixed(lead, 1) + " s in the future when the message comes",
        on_clocks(evidence.seen)));
  }
  return findings;
}

Findings stamps_rise(const Evidence& evidence) {
  Findings findings;
  for (const Stream& stream : streams(evidence.seen)) {
    std::size_t same = 0, back = 0;
    for (std::size_t i = 1; i < stream.instants.size(); ++i) {
      const Instant &before = stream.instants[i - 1], &now = stream.instants[i];
      if (now.stamp.isZero()) continue;
      same += now.stamp == before.stamp;
      back += now.stamp < before.stamp;
    }
    if (same + back == 0) continue;
    findings.push_back(wrong(text(stream.name, ": of ", stream.instants.size(), " messages ", same,
                                  " repeat the stamp before, and ", back, " go back in time"),
                             "stamp each message with its own time of measurement; a bag that starts again "
                             "must not be mixed with live data"));
  }
  return findings;
}

Findings maps_come_often_enough(const Evidence& evidence) {
  const Observations& seen = evidence.seen;
  if (seen.maps.empty() || clock_stands(seen)) return {};
  std::vector<Instant> maps, poses;
  for (const SeenMap& map : seen.maps) maps.push_back({map.at, map.at});
  for (const auto& received : seen.localization.messages) poses.push_back({received.at, received.at});
  // No pose gets two maps.
  const double expected =
      poses.size() < 2 ? seen.config.rate : std::min(seen.config.rate, rate_of(poses, seen.end));
  const double rate = rate_of(maps, seen.end);
  const std::string what = seen.map_topic.name + " comes " + fixed(rate, 1) + " times a second";
  if (rate >= 0.7 * expected) return {ok(what)};
  return {
      wrong(what + ", but rate is " + fixed(seen.config.rate, 1) + " Hz",
            "see `tick time` in /diagnostics: a tick that takes longer than its period needs shorter lines, "
            "a lower rate or a free processor")};
}

}  // namespace relative_map::doctor
