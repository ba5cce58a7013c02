// What people's files hold: numbers of other countries, units, comments, encodings, namespaces.
#include <gmock/gmock.h>

#include <clocale>
#include <cmath>

#include "relative_map/io/line_formats.hpp"
#include "relative_map/io/text.hpp"
#include "support/lines.hpp"
#include "support/temporary_folder.hpp"

namespace relative_map::core {
namespace {

using test::fault_of;
using testing::HasSubstr;

class TextFormats : public test::TemporaryFolder {
 protected:
  LineFile read(const std::string& name, const std::string& content) const {
    return read_line(write(name, content), *format_of(name));
  }
  /// What reading complains of, without the file's path; empty: nothing.
  std::string fault(const std::string& name, const std::string& content) const {
    const std::string text = fault_of([&] { read(name, content); });
    EXPECT_TRUE(text.empty() || text.find(path(name)) == 0) << text;
    return text.empty() ? "" : text.substr(path(name).size());
  }
  std::vector<LinePoint> csv(const std::string& content) const { return read("a.csv", content).line.points; }
  std::string csv_fault(const std::string& content) const { return fault("a.csv", content); }

  static std::string gpx(const std::string& point) {
    return "<gpx><trk><trkseg>\n" + point + R"(<trkpt lat="48.1" lon="11.5"/></trkseg></trk></gpx>)";
  }
  static std::string utf_16(const std::string& ascii, bool little_endian) {
    std::string bytes = little_endian ? "\xFF\xFE" : "\xFE\xFF";
    for (char c : ascii) bytes += little_endian ? std::string{c, '\0'} : std::string{'\0', c};
    return bytes;
  }
};

TEST(Text, ANumberIsTheWholeOfIt) {
  for (const char* good : {"1", "-1.5", "+2", " 3 ", "1e3", ".5", "5.", "691000.25"}) {
    EXPECT_TRUE(parse_number(good)) << good;
  }
  for (const char* bad : {"", " ", "48,137", "33.8688S", "48 08.22", "1 234.5", "0x10", "inf", "nan", "1e999",
                          "691,000.25", "48:08:22", "1e", "--1", "5m"}) {
    EXPECT_FALSE(parse_number(bad)) << bad;
  }
  if (std::setlocale(LC_ALL, "de_DE.UTF-8") != nullptr) {
    EXPECT_EQ(parse_number("1.5"), 1.5);
    std::setlocale(LC_ALL, "C");
  }
}

TEST_F(TextFormats, GpxNumbersOfOtherKindsAreRefused) {
  const auto point = [](const std::string& latitude, const std::string& rest) {
    return gpx("<trkpt lat=\"" + latitude + "\" lon=\"11.5\">" + rest + "</trkpt>");
  };
  EXPECT_EQ(fault("a.gpx", point("48.137", "<ele>520.7</ele>")), "");
  EXPECT_EQ(fault("a.gpx", point("48,137", "")),
            ": line 2: lat: '48,137' is not a number: the decimal sign must be a point");
  EXPECT_THAT(fault("a.gpx", point("33.8688S", "")),
              HasSubstr("degrees must be decimal, negative in the south"));
  EXPECT_THAT(fault("a.gpx", point("48 08.22", "")), HasSubstr("'48 08.22' is not a number"));
  EXPECT_THAT(fault("a.gpx", point("48.137", "<ele>520,7</ele>")), HasSubstr("ele: '520,7' is not a number"));
  EXPECT_THAT(fault("a.gpx", point("", "")), HasSubstr("'' is not a number"));
}

TEST_F(TextFormats, GpxIsReadWithWhateverSurroundsIt) {
  EXPECT_TRUE(
      std::isnan(read("a.gpx", gpx(R"(<trkpt lat="48.1001" lon="11.5"><ele/></trkpt>)")).line.points[0].z));
  const std::string track = gpx("");
  EXPECT_EQ(read("a.gpx", track.substr(0, track.size() - 6) + "<rte/><trk/></gpx>").line.points.size(), 1u);
  EXPECT_EQ(read("a.gpx", R"(<g:gpx xmlns:g="http://www.topografix.com/GPX/1/1"><g:trk><g:trkseg>)"
                          R"(<g:trkpt lat="48.1" lon="11.5"/></g:trkseg></g:trk></g:gpx>)")
                .line.points.size(),
            1u);
  for (bool little_endian : {true, false}) {
    EXPECT_EQ(read("a.gpx", utf_16(track, little_endian)).line.points.size(), 1u);
  }
  EXPECT_EQ(read("a.gpx", "\xEF\xBB\xBF" + track).line.points.size(), 1u);
}

TEST_F(TextFormats, GapsBetweenPartsAreTold) {
  const LineFile track = read("a.gpx", R"(<gpx><trk>
<trkseg><trkpt lat="48.1" lon="11.5"/><trkpt lat="48.1001" lon="11.5"/></trkseg><trkseg/>
<trkseg><trkpt lat="48.1011" lon="11.5"/></trkseg></trk></gpx>)");
  ASSERT_EQ(track.notes.size(), 1u);
  EXPECT_THAT(track.notes[0], HasSubstr("2 parts"));
  EXPECT_THAT(track.notes[0], HasSubstr("111.2 m, before point 2"));
  const LineFile line = read("a.geojson", R"({"type": "MultiLineString", "coordinates":
[[[11.5, 48.1], [11.5, 48.1001]], [[11.5, 48.1002]]]})");
  ASSERT_EQ(line.notes.size(), 1u);
  EXPECT_THAT(line.notes[0], HasSubstr("11.1 m, before point 2"));
}

TEST_F(TextFormats, PointsThatWereNeverSetAreLeftOutAndTold) {
  for (const auto& [name, content] : std::map<std::string, std::string>{
           {"a.gpx", gpx(R"(<trkpt lat="0" lon="0"/><trkpt lat="0.0" lon="-0"/>)")},
           {"a.csv", "lat,lon\n0,0\n48.1,11.5\n0.0,0.0\n"},
           {"a.geojson", R"({"type": "LineString", "coordinates": [[0, 0], [11.5, 48.1], [0, 0]]})"}}) {
    const LineFile file = read(name, content);
    EXPECT_EQ(file.line.points.size(), 1u) << name;
    ASSERT_EQ(file.notes.size(), 1u) << name;
    EXPECT_EQ(file.notes[0], "2 points at longitude 0, latitude 0 are left out: there was no fix");
  }
  EXPECT_THAT(csv_fault("lat,lon\n0,0\n"), HasSubstr("all of its points are at longitude 0"));
  EXPECT_EQ(csv("x,y\n0,0\n1,0\n").size(), 2u);  // a map frame may begin there
}

TEST_F(TextFormats, CsvIsReadByTheLetterOfRfc4180) {
  EXPECT_EQ(csv("\"x\",\"y\"\r\n\"1\",\"2\"\r\n")[0].y, 2.0);
  EXPECT_EQ(csv("x,\"a \"\"note\"\", of\ntwo lines\",y\n1,\"#,\n\",2\n3,,4\n")[1].y, 4.0);
  EXPECT_EQ(csv_fault("x,y\n\"691,000.25\",\"5,335,000.50\"\n"),
            ", line 2: '691,000.25' is not a number: thousands must not be set apart");
  EXPECT_EQ(csv_fault("note,x,y\n\"two\nlines\",1,2\nq,1,b\n"), ", line 4: 'b' is not a number");
  EXPECT_THAT(csv_fault("x,y\n\"1\"0,2\n"), HasSubstr("line 2: '0' stands behind a closing quote"));
  EXPECT_THAT(csv_fault("x,y\n1\"0,2\n"), HasSubstr("line 2: a quote stands within a cell"));
  EXPECT_THAT(csv_fault("x,y\n1,2\n\"3,4\n"), HasSubstr("line 3: a quote is not closed"));
}

TEST_F(TextFormats, CsvCellsMustFitTheColumns) {
  EXPECT_EQ(csv_fault("x,y\n1,2,3\n"), ", line 2: has 3 cells, but there are 2 columns");
  EXPECT_EQ(csv_fault("1,2\n1,2,3\n"), ", line 2: has 3 cells, but there are 2 columns");
  EXPECT_EQ(csv_fault("x,y\n691000,25,5335000,50\n"), ", line 2: has 4 cells, but there are 2 columns");
  EXPECT_THAT(csv_fault("0.1,1,2,3\n"), HasSubstr("line 1: has 4 columns, and no line that names them"));
  EXPECT_THAT(csv_fault("x,y,X\n1,2,3\n"), HasSubstr("line 1: there are two columns of x"));
  EXPECT_THAT(csv_fault("1,2\nx,y\n"), HasSubstr("line 2: 'x' is not a number"));
  EXPECT_EQ(csv(",x,y\n0,1,2\n1,3,4\n")[1].x, 3.0);  // as pandas writes an index
}

TEST_F(TextFormats, CsvColumnsMayBeNamedInAComment) {
  const std::vector<LinePoint> track = csv("# s_m; x_m; y_m\n0.0; 10; 20\n1.0; 11; 20\n");
  EXPECT_EQ(track[1].x, 11.0);
  EXPECT_EQ(track[1].s, 1.0);
  EXPECT_EQ(csv("# time,x,y\n1.7e9,10,20\n")[0].x, 10.0);
  EXPECT_EQ(csv("# by hand\n#x,y,kappa\n10,20,0.1\n")[0].kappa, 0.1);
  EXPECT_EQ(csv("# a line, from Monday\n10,20\n")[0].x, 10.0);
  EXPECT_EQ(csv("# time x y\n1.7e9 10 20\n")[0].x, 10.0);
  EXPECT_EQ(csv("# a lap\n10 20\n")[0].x, 10.0);
  EXPECT_THAT(csv_fault("# time,speed,height\n1.7e9,10,20\n"),
              HasSubstr("line 1: there must be columns x and y"));
  EXPECT_THAT(csv_fault("# time,x,y\n10,20\n"), HasSubstr("line 1: names 3 columns, but there are 2"));
}

TEST_F(TextFormats, CsvColumnsMayHaveUnits) {
  EXPECT_EQ(csv("y [m],x (m),theta_rad\n1,2,0.5\n")[0].theta, 0.5);
  EXPECT_EQ(csv("Easting [m];Northing [m]\n691000.5;5335000\n")[0].x, 691000.5);
  EXPECT_THAT(csv_fault("x [km],y [km]\n1,2\n"), HasSubstr("column 'x [km]' is in km, but x must be in m"));
  EXPECT_THAT(csv_fault("x_m,y_m,theta_deg\n1,2,3\n"),
              HasSubstr("'theta_deg' is in deg, but theta must be in rad"));
  EXPECT_THAT(csv_fault("lat [rad],lon [rad]\n0.8,0.2\n"), HasSubstr("lat must be in deg"));
  const LineFile file = read("a.csv", "time,x,y,vx_mps\n1,2,3,4\n");
  ASSERT_EQ(file.notes.size(), 1u);
  EXPECT_EQ(file.notes[0], "these columns are left out: time, vx_mps");
}

TEST_F(TextFormats, CsvMayComeInAnyEncodingAndWithAnyLineEnd) {
  for (const std::string& content :
       {std::string("x,y\r1,2\r3,4\r"), std::string("\xEF\xBB\xBFx,y\r\n1,2\r\n3,4"),
        utf_16("x,y\r\n1,2\r\n3,4\r\n", true), utf_16("x,y\n1,2\n3,4\n", false)}) {
    ASSERT_EQ(csv(content).size(), 2u);
    EXPECT_EQ(csv(content)[1].x, 3.0);
  }
  EXPECT_THAT(csv_fault(std::string("x,y\n1,\0\n", 8)), HasSubstr("is no text"));
  EXPECT_THAT(csv_fault(utf_16("x,y\n1,2\n", true) + "3"), HasSubstr("UTF-16"));
}

TEST_F(TextFormats, LongNamesAndWildQuotesDoNoHarm) {
  EXPECT_NE(csv_fault(std::string(1000000, 'x') + ",y\n1,2\n"), "");
  EXPECT_NE(csv_fault("#" + std::string(1000000, 'x') + ",y\n" + std::string(1000000, '(') + "\n"), "");
}

TEST_F(TextFormats, JsonMayBePrettyPrinted) {
  const std::string pretty =
      "{\n  \"header\": {\n    \"frame_id\": \"odom\"\n  }\n}\n{\n  \"x\": 1,\n  \"y\": 2\n}\n";
  EXPECT_EQ(read("a.smoothed", pretty).line.points.size(), 1u);
  EXPECT_EQ(read("a.smoothed", pretty).header.frame_id, "odom");
  EXPECT_EQ(read("a.json", "[\n  {\n    \"x\": 1,\n    \"y\": 2\n  },\n  {\"x\": 3, \"y\": 4}\n]\n")
                .line.points.size(),
            2u);
  EXPECT_EQ(read("a.smoothed", "\xEF\xBB\xBF{\"x\": 1, \"y\": 2}\r{\"x\": 3, \"y\": 4}\r").line.points.size(),
            2u);
  EXPECT_EQ(fault("a.json", "[{\"x\": 1, \"y\": 2}\n{\"x\": 3, \"y\": 4}]"),
            ", line 2: not valid JSON near column 1");
  EXPECT_EQ(fault("a.json", "[{\"x\": 1, \"y\": 2},\n"), ", line 2: not valid JSON near column 1");
  EXPECT_EQ(fault("a.smoothed", "{\n  \"x\": 1,\n  \"y\": 2,,\n}\n"),
            ", line 3: not valid JSON near column 10");
  EXPECT_THAT(fault("a.smoothed", R"({"type": "LineString", "coordinates": []})"),
              HasSubstr("this is GeoJSON"));
}

TEST_F(TextFormats, GeoJsonMayBeOfAnyLayoutAndOnlyOfWgs84) {
  const std::string line = R"({"type": "LineString", "coordinates": [[11.5, 48.1, null], [11.51, 48.1, 5]]})";
  EXPECT_TRUE(std::isnan(read("a.geojson", line).line.points[0].z));
  const std::string point = R"({"type": "Feature", "geometry": {"type": "Point", "coordinates": [1, 2]}})";
  EXPECT_EQ(read("a.geojson", point + "\n" + line + "\n").line.points.size(), 2u);
  EXPECT_EQ(read("a.geojsonl", "\x1E" + line + "\n").line.points.size(), 2u);
  EXPECT_THAT(fault("a.geojson", line + "\n" + line), HasSubstr("has 2 LineStrings"));
  const auto with_crs = [&](const std::string& crs) {
    return line.substr(0, line.size() - 1) + R"(, "crs": {"type": "name", "properties": {"name": ")" + crs +
           "\"}}}";
  };
  EXPECT_EQ(fault("a.geojson", with_crs("urn:ogc:def:crs:OGC:1.3:CRS84")), "");
  EXPECT_THAT(fault("a.geojson", with_crs("urn:ogc:def:crs:EPSG::25832")),
              HasSubstr("its crs is urn:ogc:def:crs:EPSG::25832"));
}

TEST_F(TextFormats, AZoneOfTheOtherHemisphereIsRefused) {
  const std::string file = write("a.csv", "lat,lon\n48.1,11.5\n48.1001,11.5\n");
  EXPECT_THAT(fault_of([&] { read_line(file, LineFormat::kCsv, {parse_utm_zone("32S")}); }),
              HasSubstr("the other side of the equator from UTM zone 32S"));
  EXPECT_EQ(fault_of([&] { read_line(file, LineFormat::kCsv, {parse_utm_zone("32N")}); }), "");
}

}  // namespace
}  // namespace relative_map::core
