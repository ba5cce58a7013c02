#include "relative_map/io/line_formats.hpp"

#include <gmock/gmock.h>

#include <sys/stat.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "relative_map/io/whole_file.hpp"
#include "support/lines.hpp"
#include "support/temporary_folder.hpp"

namespace relative_map::core {
namespace {

using test::fault_of;
using test::kNaN;
using testing::HasSubstr;

constexpr double kLossless = 1e-6;  // [m]

GeoReference utm(int zone, bool north) {
  GeoReference reference;
  reference.projection = Projection::kUtm;
  reference.zone = zone;
  reference.north = north;
  return reference;
}

GeoReference local(double latitude, double longitude, double altitude) {
  GeoReference reference;
  reference.projection = Projection::kLocal;
  reference.latitude = latitude;
  reference.longitude = longitude;
  reference.altitude = altitude;
  return reference;
}

/// 2 km that wind through map-sized coordinates.
LineFile sample(const GeoReference& reference, const Point2& start, bool with_z) {
  LineFile file;
  file.header = {"map", reference};
  file.line.name = "line";
  for (int i = 0; i < 2000; ++i) {
    const Point2 p = start + Point2(i * 0.97, 100.0 * std::sin(i / 200.0)) + Point2(1e-7 / 3.0, 1e-6 / 7.0);
    file.line.points.push_back({p.x(), p.y(), with_z ? 50.0 + i / 300.0 : kNaN, kNaN, kNaN, kNaN, kNaN});
  }
  return file;
}

void expect_same(const LineFile& actual, const LineFile& expected) {
  EXPECT_EQ(to_json(actual.header), to_json(expected.header));
  ASSERT_EQ(actual.line.points.size(), expected.line.points.size());
  for (std::size_t i = 0; i < expected.line.points.size(); ++i) {
    const LinePoint &a = actual.line.points[i], &b = expected.line.points[i];
    ASSERT_NEAR(a.x, b.x, kLossless) << i;
    ASSERT_NEAR(a.y, b.y, kLossless) << i;
    ASSERT_EQ(std::isnan(a.z), std::isnan(b.z)) << i;
    if (!std::isnan(b.z)) {
      ASSERT_NEAR(a.z, b.z, kLossless) << i;
    }
  }
}

class LineFormats : public test::TemporaryFolder {
 protected:
  std::string csv_fault(const std::string& content) const {
    const std::string file = write("line.csv", content);
    const std::string fault = fault_of([&] { read_line(file, LineFormat::kCsv); });
    EXPECT_TRUE(fault.empty() || fault.find(file) == 0) << fault;
    return fault.empty() ? "" : fault.substr(file.size());
  }
};

TEST_F(LineFormats, RoundTripsAreLossless) {
  const std::vector<LineFile> files = {sample(utm(50, true), {691188.6, 3118142.6}, true),
                                       sample(utm(33, false), {350000.0, 6243000.0}, false),
                                       sample(local(48.137, 11.575, 520.0), {-800.0, 30000.0}, true),
                                       sample(local(-33.9, 18.4, 0.0), {0.0, 0.0}, false)};
  for (const LineFile& file : files) {
    for (const char* name : {"a.smoothed", "a.json", "a.csv", "a.gpx", "a.geojson"}) {
      SCOPED_TRACE(std::string(name) + ", " + describe(file.header.reference));
      write_line(path(name), *format_of(name), file);
      expect_same(read_line(path(name), *format_of(name)), file);
    }
    for (char separator : {',', ';', '\t', ' ', '|'}) {
      for (bool geographic : {false, true}) {
        if (separator == ' ' && std::isnan(file.line.points[0].z)) continue;  // blanks can't show a gap
        SCOPED_TRACE(std::string("separator '") + separator + "' " + describe(file.header.reference));
        write_line(path("b.csv"), LineFormat::kCsv, file, {separator, geographic});
        expect_same(read_line(path("b.csv"), LineFormat::kCsv), file);
      }
    }
  }
}

TEST_F(LineFormats, AllFieldsGoThroughCsvAndOneLine) {
  LineFile file;
  file.line.points = {{1.0, 2.0, 3.0, 0.1, 0.01, -0.001, 0.0}, {1.5, 2.0, kNaN, 0.2, 0.02, -0.002, 0.5}};
  for (const char* name : {"a.csv", "a.json"}) {
    write_line(path(name), *format_of(name), file);
    const LineFile back = read_line(path(name), *format_of(name));
    ASSERT_EQ(back.line.points.size(), 2u);
    EXPECT_EQ(back.line.points[1].theta, 0.2);
    EXPECT_EQ(back.line.points[1].kappa, 0.02);
    EXPECT_EQ(back.line.points[1].dkappa, -0.002);
    EXPECT_EQ(back.line.points[1].s, 0.5);
    EXPECT_TRUE(std::isnan(back.line.points[1].z));
  }
}

TEST_F(LineFormats, ObjectsMayShareALine) {
  const std::string a = R"({"x": 1, "y": 2})", b = R"({"y": 4, "x": 3, "name": "} \" \\"})";
  const std::string header = R"({"header": {"frame_id": "odom"}})";
  for (const std::string& content : {a + b, a + ", " + b, a + " " + b + "\n", "[" + a + ", " + b + "]"}) {
    const LineFile file = read_line_file(write("line.json", content));
    ASSERT_EQ(file.line.points.size(), 2u) << content;
    EXPECT_EQ(file.line.points[1].x, 3.0);
  }
  EXPECT_EQ(read_line_file(write("line.json", "[" + header + ", " + a + "]")).header.frame_id, "odom");
  EXPECT_EQ(read_line_file(write("line.json", header + a)).header.frame_id, "odom");
}

TEST_F(LineFormats, TheWriterPutsOneObjectOnEachLineOrAllOnOne) {
  const LineFile file = sample(utm(50, true), {691188.6, 3118142.6}, true);
  const auto lines = [&](const char* name, LineFormat format) {
    write_line(path(name), format, file);
    const std::string content = read_whole_file(path(name));
    return std::count(content.begin(), content.end(), '\n');
  };
  EXPECT_EQ(lines("a.smoothed", LineFormat::kSmoothed), 2001);  // with the header
  EXPECT_EQ(lines("a.json", LineFormat::kOneLine), 1);
}

TEST_F(LineFormats, CsvReadsWhatOthersWrite) {
  const auto read = [&](const std::string& content) {
    return read_line(write("line.csv", content), LineFormat::kCsv).line.points;
  };
  EXPECT_EQ(read("1,2\n3,4\n").size(), 2u);
  EXPECT_EQ(read("1 2 3\n  3\t4   5\n")[1].z, 5.0);
  EXPECT_EQ(read("# taken in May\n\"Y\";\"X\"\r\n1;2\r\n\r\n3;4\r\n")[1].x, 4.0);
  EXPECT_EQ(read("time,x,note,y\n17,1,,2\n18,3,wet,4\n")[1].y, 4.0);
  EXPECT_EQ(read("\xEF\xBB\xBFx|y|z\n1|2|\n3|4|5\n")[1].z, 5.0);
}

TEST_F(LineFormats, CsvNamesTheLineAndTheFault) {
  EXPECT_EQ(csv_fault("1,2\n3,4\n"), "");
  EXPECT_EQ(csv_fault(""), ": has no points");
  EXPECT_EQ(csv_fault("x,y\n"), ": has no points");
  EXPECT_EQ(csv_fault("x,y\n1,2\n3;4\n"),
            ", line 3: has 1 of 2 numbers, since ';' stands between them, and ',' in the first line");
  EXPECT_EQ(csv_fault("1;2\n3\t4\n"),
            ", line 2: has 1 of 2 numbers, since a tab stands between them, and ';' in the first line");
  EXPECT_EQ(csv_fault("x;y\n1,5;2,5\n"), ", line 2: '1,5' is not a number: the decimal sign must be a point");
  EXPECT_EQ(csv_fault("x,y\n1,2\n3,\n"), ", line 3: x or y is missing or not finite");
  EXPECT_EQ(csv_fault("x,y\n1,NaN\n"), ", line 2: x or y is missing or not finite");
  EXPECT_EQ(csv_fault("x,y\n1,inf\n"), ", line 2: 'inf' is not a number");
  EXPECT_THAT(csv_fault("time,x\n1,2\n"), HasSubstr("line 1: there must be columns x and y, or lon and lat"));
  EXPECT_THAT(csv_fault("lat,x\n1,2\n"), HasSubstr("line 1: there must be columns x and y, or lon and lat"));
}

TEST_F(LineFormats, SwappedLongitudeAndLatitudeAreFound) {
  EXPECT_EQ(csv_fault("lon,lat\n116.3,39.9\n116.4,39.9\n"), "");
  EXPECT_EQ(csv_fault("lon,lat\n39.9,116.3\n39.9,116.4\n"),
            ": point 0 has latitude 116.3, beyond 90 degrees; are longitude and latitude swapped?");
  // Where both are possible, the place that it was meant for tells.
  const std::string swapped = write("line.csv", "lon,lat\n48.1,11.5\n48.1,11.51\n");
  for (const GeoReference& reference : {utm(32, true), local(48.1, 11.5, 500.0)}) {
    EXPECT_THAT(fault_of([&] { read_line(swapped, LineFormat::kCsv, {reference}); }), HasSubstr("swapped"));
  }
}

TEST_F(LineFormats, AChangeOfZoneNeedsAWord) {
  const std::string file = write("line.csv", "lon,lat\n11.99,48.1\n12.01,48.1\n");
  EXPECT_EQ(
      fault_of([&] { read_line(file, LineFormat::kCsv); }),
      file +
          ": point 1 lies in UTM zone 33N, those before it in UTM zone 32N: name one zone for all, or take a "
          "local frame");
  const LineFile forced = read_line(file, LineFormat::kCsv, {utm(32, true)});
  const Point2 step(forced.line.points[1].x - forced.line.points[0].x,
                    forced.line.points[1].y - forced.line.points[0].y);
  EXPECT_NEAR(step.norm(), 0.02 * kPi / 180.0 * 6378137.0 * std::cos(48.1 * kPi / 180.0), 5.0);
}

TEST_F(LineFormats, TheEquatorIsNoBorder) {
  const std::string file = write("line.csv", "lon,lat\n9.0,-0.0001\n9.0,0.0001\n");
  const LineFile line = read_line(file, LineFormat::kCsv);
  EXPECT_FALSE(line.header.reference.north);
  EXPECT_NEAR(line.line.points[1].y - line.line.points[0].y, 22.11, 0.02);
  write_line(path("b.csv"), LineFormat::kCsv, line, {',', true});
  expect_same(read_line(path("b.csv"), LineFormat::kCsv), line);
}

TEST_F(LineFormats, WhatIsNotOnTheEarthCannotBeWrittenSo) {
  LineFile file = sample({}, {0.0, 0.0}, true);
  write_line(path("a.csv"), LineFormat::kCsv, file);  // x and y are fine
  for (const char* name : {"a.gpx", "a.geojson"}) {
    EXPECT_THAT(fault_of([&] { write_line(path(name), *format_of(name), file); }),
                HasSubstr("not written, since the line's place on the earth is not known"));
  }
  file.header.reference = utm(50, true);
  file.line.points[5].y = 2e7;
  EXPECT_THAT(fault_of([&] { write_line(path("a.gpx"), LineFormat::kGpx, file); }), HasSubstr("point 5"));
  EXPECT_EQ(files_in_folder(), 1u);
}

TEST_F(LineFormats, BrokenXmlAndJsonAreNamed) {
  const auto gpx = [&](const std::string& content) {
    return fault_of([&] { read_line(write("a.gpx", content), LineFormat::kGpx); });
  };
  EXPECT_THAT(gpx(""), HasSubstr("has no points"));
  EXPECT_THAT(gpx("<gpx><trk><trkseg><trkpt lat=\"1\" lon=\"2\"/>"), HasSubstr("no whole XML file"));
  EXPECT_THAT(gpx("<kml/>"), HasSubstr("no element 'gpx'"));
  EXPECT_THAT(gpx("<gpx/>"), HasSubstr("has 0 tracks and routes"));
  EXPECT_THAT(gpx("<gpx><trk><trkseg><trkpt lat=\"1\" lon=\"2\"/></trkseg></trk>"
                  "<rte><rtept lat=\"1\" lon=\"2\"/></rte></gpx>"),
              HasSubstr("has 2 tracks and routes"));
  EXPECT_THAT(gpx("<gpx><trk/></gpx>"), HasSubstr("has no points"));
  EXPECT_THAT(gpx("<gpx><trk><trkseg>\n<trkpt lat=\"1\"/></trkseg></trk></gpx>"),
              HasSubstr("line 2: a point lacks lat or lon"));
  const auto geojson = [&](const std::string& content) {
    return fault_of([&] { read_line(write("a.geojson", content), LineFormat::kGeoJson); });
  };
  EXPECT_THAT(geojson(""), HasSubstr("has no points"));
  EXPECT_THAT(geojson("{\"type\": \"LineString\", \"coordinates\": [[1, 2]"),
              HasSubstr("line 1: not valid JSON near column"));
  EXPECT_THAT(geojson("{\"type\": \"Point\"}"), HasSubstr("has 0 LineStrings"));
  EXPECT_THAT(geojson("{\"type\": \"LineString\", \"coordinates\": [[1, 2], [\"a\", 2]]}"),
              HasSubstr("position 1"));
  EXPECT_THAT(geojson("{\"type\": \"LineString\", \"coordinates\": []}"), HasSubstr("has no points"));
}

TEST_F(LineFormats, GeoJsonIsFoundInWhateverItIsWrappedIn) {
  const std::string line = R"({"type": "LineString", "coordinates": [[11.5, 48.1], [11.51, 48.1]]})";
  const std::string feature = R"({"type": "Feature", "properties": null, "geometry": )" + line + "}";
  for (const std::string& content :
       {line, feature, R"({"type": "FeatureCollection", "features": [)" + feature + "]}",
        std::string(R"({"type": "MultiLineString", "coordinates": [[[11.5, 48.1]], [[11.51, 48.1]]]})")}) {
    EXPECT_EQ(read_line(write("a.geojson", content), LineFormat::kGeoJson).line.points.size(), 2u) << content;
  }
}

TEST(LineHeaders, ConflictWhereFrameZoneOrOriginDiffer) {
  const LineHeader none, map{"map", utm(50, true)};
  EXPECT_EQ(conflict(none, map), "");
  EXPECT_EQ(conflict(map, map), "");
  EXPECT_EQ(conflict(map, {"odom", {}}), "one is in frame 'map', the other in 'odom'");
  EXPECT_EQ(conflict(map, {"", utm(51, true)}), "one is in UTM zone 50N, the other in UTM zone 51N");
  EXPECT_NE(conflict(map, {"map", utm(50, false)}), "");
  EXPECT_NE(conflict({"", local(48.0, 11.0, 0.0)}, {"", local(48.0, 11.00001, 0.0)}), "");
  EXPECT_NE(conflict({"", local(48.0, 11.0, 0.0)}, map), "");
}

TEST(LineHeaders, ThatHoldNonsenseAreRefused) {
  EXPECT_TRUE(is_empty(parse_line_header(R"({"zone": 50})")));  // another tool's
  for (const char* fields : {R"("frame_id": 3)", R"("projection": "mercator")", R"("projection": "utm")",
                             R"("projection": "utm", "zone": 61, "north": true)",
                             R"("projection": "utm", "zone": 50, "north": "yes")",
                             R"("projection": "local", "latitude": 95, "longitude": 0, "altitude": 0)"}) {
    EXPECT_NE(fault_of([&] { parse_line_header(R"({"header": {)" + std::string(fields) + "}}"); }), "")
        << fields;
  }
}

TEST(LineHeaders, AreMergedFieldByField) {
  LineHeader known{"map", {}};
  EXPECT_EQ(merge(known, {"", utm(32, true)}), "");
  EXPECT_EQ(known.frame_id, "map");
  EXPECT_EQ(merge(known, {"map", utm(33, true)}), "one is in UTM zone 32N, the other in UTM zone 33N");
  EXPECT_EQ(known.reference.zone, 32);
}

TEST(LineHeaders, BridgedGapsAreKept) {
  LineHeader header;
  header.bridged = {{1.5, 2.0, 65.25, -3.0}};
  const LineHeader back = parse_line_header(to_json(header));
  ASSERT_EQ(back.bridged.size(), 1u);
  EXPECT_EQ(back.bridged[0].to_x, 65.25);
  EXPECT_NE(fault_of([] { parse_line_header(R"({"header": {"bridged": [[1, 2, 3]]}})"); }), "");
}

class WholeFile : public test::TemporaryFolder {};

TEST_F(WholeFile, OnlyRegularFilesAreReadAndNeverWaitedFor) {
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  for (const std::string& place : {path("pipe"), std::string("/dev/zero"), std::string("/dev/null")}) {
    EXPECT_THAT(fault_of([&] { read_whole_file(place); }), HasSubstr(place + ": is a pipe, a device"));
    EXPECT_THAT(fault_of([&] { read_line(place, LineFormat::kGpx); }), HasSubstr("is a pipe, a device"));
  }
  EXPECT_THAT(fault_of([&] { read_whole_file(path(".")); }), HasSubstr("is a folder"));
  EXPECT_NE(read_whole_file("/proc/self/status"), "");  // says that its size is 0
}

TEST_F(WholeFile, WhatIsTooLargeIsNotRead) {
  const std::string file = write("large", "12345678");
  EXPECT_EQ(read_whole_file(file, 8), "12345678");
  EXPECT_THAT(fault_of([&] { read_whole_file(file, 7); }), HasSubstr("is larger than"));
  std::filesystem::resize_file(file, std::uintmax_t{1} << 40);  // a hole: nothing is on the disk
  EXPECT_THAT(fault_of([&] { read_whole_file(file); }), HasSubstr("is larger than 160 MiB"));
}

TEST_F(WholeFile, AnInputIsNoOutputByAnyName) {
  const std::string file = write("a", "a");
  std::filesystem::create_symlink("a", path("b"));
  std::filesystem::create_hard_link(path("a"), path("c"));
  for (const char* name : {"a", "b", "c", "./a"}) {
    EXPECT_THAT(fault_of([&] {
                  expect_not_among(path(name), {path("x"), file});
                }),
                HasSubstr("it is read from"));
  }
  EXPECT_EQ(fault_of([&] { expect_not_among(path("d"), {file}); }), "");
}

TEST_F(WholeFile, AFullDiskHarmsNothing) {
  EXPECT_THAT(fault_of([] { write_whole_file("/dev/full", "text"); }),
              HasSubstr("cannot write /dev/full: No space left on device"));
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
}

TEST_F(WholeFile, KeepsModeAndLinkOfWhatItReplaces) {
  write("old", "old");
  std::filesystem::permissions(path("old"), std::filesystem::perms(0640));
  std::filesystem::create_symlink("old", path("link"));
  write_whole_file(path("link"), "new");
  EXPECT_EQ(read_whole_file(path("old")), "new");
  EXPECT_TRUE(std::filesystem::is_symlink(path("link")));
  EXPECT_EQ(std::filesystem::status(path("old")).permissions(), std::filesystem::perms(0640));
  EXPECT_EQ(files_in_folder(), 2u);
}

TEST_F(WholeFile, WhatCannotBeWrittenIsSaidAndLeftAlone) {
  std::filesystem::create_directory(path("folder"));
  write("old", "old");
  for (const std::string& target :
       {path("folder"), path("absent/file"), path("old/file"), std::string("/proc/file")}) {
    EXPECT_THAT(fault_of([&] { write_whole_file(target, "new"); }), HasSubstr("cannot write " + target));
  }
  EXPECT_EQ(files_in_folder(), 2u);
  EXPECT_EQ(read_whole_file(path("old")), "old");
}

}  // namespace
}  // namespace relative_map::core
