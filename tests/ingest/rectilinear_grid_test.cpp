#include "ingest/rectilinear_grid.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>
#include <string>

#include "small_raster.h"

namespace terrane::ingest {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using std::string_literals::operator""s;
using testing::input_error_of;
using testing::RasterFolder;

// posts at x 0, 1, 3; y 10, 20; z -5, 5; the value of a post is its number
constexpr const char* kAscii = R"(<?xml version="1.0"?>
<VTKFile type="RectilinearGrid" version="0.1" byte_order="LittleEndian">
  <RectilinearGrid WholeExtent="0 2 0 1 0 1">
    <Piece Extent="0 2 0 1 0 1">
      <PointData Scalars="T">
        <DataArray type="Float32" Name="T" NumberOfComponents="1" format="ascii">
          0 1 2 3 4 5
          6 7 8 9 10 1.1e1
        </DataArray>
        <DataArray type="Float32" Name="wind" NumberOfComponents="3" format="ascii">0 0 1</DataArray>
      </PointData>
      <CellData><DataArray type="Int32" Name="cell" format="ascii">9 9</DataArray></CellData>
      <Coordinates>
        <DataArray type="Float64" Name="x" format="ascii">0 1 3</DataArray>
        <DataArray type="Float64" Name="y" format="ascii">10 20</DataArray>
        <DataArray type="Float64" Name="z" format="ascii">-5 5</DataArray>
      </Coordinates>
    </Piece>
  </RectilinearGrid>
</VTKFile>
)";

std::string with(std::string text, const std::string& what, const std::string& instead) {
  text.replace(text.find(what), what.size(), instead);
  return text;
}

std::string refusal(const std::string& bytes, const std::string& array = "T") {
  const RasterFolder folder;
  const std::string file = folder.write_text("field.vtr", bytes);
  return input_error_of([&] { read_rectilinear_grid(file, array); });
}

void expect_numbered_posts(const std::filesystem::path& file, const std::string& array, int first) {
  SCOPED_TRACE(file.string() + " " + array);
  const RectilinearGrid grid = read_rectilinear_grid(file, array);
  EXPECT_THAT(grid.axes[0], ElementsAre(0, 1, 3));
  EXPECT_THAT(grid.axes[1], ElementsAre(10, 20));
  EXPECT_THAT(grid.axes[2], ElementsAre(-5, 5));
  std::vector<double> numbers(12);
  std::iota(numbers.begin(), numbers.end(), first);
  EXPECT_EQ(grid.values, numbers);
}

void expect_numbered_posts(const std::string& bytes) {
  const RasterFolder folder;
  expect_numbered_posts(folder.write_text("field.vtr", bytes), "T", 0);
}

TEST(RectilinearGrid, ReadsWhatVtkWritesInEveryEncoding) {
  const std::filesystem::path folder =
      std::filesystem::path(TERRANE_SOURCE_DIR) / "tests" / "ingest" / "vtk_grids";
  for (const char* name : {"ascii", "inline_plain", "inline_zlib", "appended_base64_plain",
                           "appended_base64_zlib", "appended_raw_big", "appended_raw_zlib"}) {
    const auto file = folder / (std::string(name) + ".vtr");
    expect_numbered_posts(file, "T", 0);
    expect_numbered_posts(file, "S", 12);
  }
}

TEST(RectilinearGrid, ReadsTheHeaderOfBase64ByItselfOrWithTheData) {
  const std::string text = "<DataArray type=\"Float64\" Name=\"y\" format=\"ascii\">10 20<";
  // 16 bytes, then 10 and 20: the header padded (as VTK writes it), and in one piece
  for (const char* coded : {"EAAAAA==AAAAAAAAJEAAAAAAAAA0QA==", "EAAAAAAAAAAAACRAAAAAAAAANEA="}) {
    expect_numbered_posts(
        with(kAscii, text,
             std::string("<DataArray type=\"Float64\" Name=\"y\" format=\"binary\">\n ") + coded +
                 "\n<"));
  }
}

TEST(RectilinearGrid, ReadsRawBytesBehindTheXml) {
  std::string bytes = with(kAscii, "version=\"0.1\" byte_order=\"LittleEndian\"",
                           "version=\"1.0\" byte_order=\"BigEndian\" header_type=\"UInt64\"");
  bytes = with(bytes, "format=\"ascii\">-5 5<", "format=\"appended\" offset=\"3\"><");
  bytes = with(bytes, "type=\"Float64\" Name=\"z\"", "type=\"Int16\" Name=\"z\"");
  // three bytes of another array, the count, -5 and 5
  const std::string data =
      "\n<AppendedData encoding=\"raw\">\n_<&_\0\0\0\0\0\0\0\4\xff\xfb\0\5</AppendedData>"s;
  expect_numbered_posts(with(bytes, "\n</VTKFile>", data + "\n</VTKFile>"));
}

TEST(RectilinearGrid, SaysWhichArraysThereAre) {
  EXPECT_THAT(refusal(kAscii, "S"),
              AllOf(HasSubstr("field.vtr"), HasSubstr("'S'"), HasSubstr("T, wind")));
  EXPECT_THAT(refusal(kAscii, "cell"), HasSubstr("at its points"));
  EXPECT_THAT(refusal(kAscii, ""), HasSubstr("T, wind"));
  EXPECT_THAT(refusal(kAscii, "wind"), HasSubstr("3 components"));
}

TEST(RectilinearGrid, RefusesWhatIsNoGridInOneLine) {
  EXPECT_THAT(refusal("Dear Sir or Madam"), HasSubstr("no VTK rectilinear grid"));
  EXPECT_THAT(refusal(with(kAscii, "1.1e1", "")), HasSubstr("11 values for 3 x 2 x 2 posts"));
  EXPECT_THAT(refusal(with(kAscii, "1.1e1", "eleven")), HasSubstr("'eleven' is no number"));
  EXPECT_THAT(refusal(with(kAscii, ">10 20<", ">10<")), HasSubstr("3 x 1 x 2"));
  EXPECT_THAT(refusal(with(kAscii, "\"LittleEndian\"",
                           "\"LittleEndian\" compressor=\"vtkLZ4DataCompressor\"")),
              HasSubstr("vtkLZ4DataCompressor"));
  EXPECT_THAT(refusal(with(kAscii, "format=\"ascii\">10 20<", "format=\"binary\">EAAAAA==AAAA<")),
              AllOf(HasSubstr("'y'"), HasSubstr("end before")));
  EXPECT_THAT(refusal(with(kAscii, "format=\"ascii\">10 20<", "format=\"binary\">/////w==AAAA<")),
              HasSubstr("end before"));
  EXPECT_THAT(
      refusal(with(kAscii, "format=\"ascii\">10 20<", "format=\"appended\" offset=\"7\"><")),
      HasSubstr("beyond the file"));
}

}  // namespace
}  // namespace terrane::ingest
