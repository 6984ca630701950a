#include "viewer/server/index_page.h"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>

#include "viewer/server/url_path.h"

namespace terrane::viewer {
namespace {

using nlohmann::json;

constexpr std::string_view kHead = R"(<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width">
<title>terrane</title>
<style>
  body { font: 1rem/1.5 system-ui, sans-serif; max-width: 44rem; margin: 3rem auto; padding: 0 1rem;
         color: #222; background: #fff }
  h1 { font-size: 1.2rem } li { margin: 1rem 0 } small { color: #555 }
  ul { padding: 0; list-style: none } a { margin-right: 1rem }
  @media (prefers-color-scheme: dark) { body { color: #ddd; background: #181818 }
    small { color: #aaa } a { color: #8bf } }
</style>
<h1>Data sets</h1>
<ul>
)";

/// What a client is given to open a data set.
struct Document {
  std::string_view file;
  std::string_view label;
};
constexpr std::array kDocuments = {
    Document{"tileset.json", "3D Tiles"}, Document{"layer.json", "quantized-mesh"},
    Document{"tiles.json", "TileJSON"}, Document{"tilejson.json", "TileJSON"},
    Document{"terrane.json", "levels and errors"}};

std::string escaped(std::string_view text) {
  std::string html;
  for (const char c : text) {
    switch (c) {
      case '&':
        html += "&amp;";
        break;
      case '<':
        html += "&lt;";
        break;
      case '>':
        html += "&gt;";
        break;
      case '"':
        html += "&quot;";
        break;
      default:
        html += c;
    }
  }
  return html;
}

/// One line about a terrane.json; empty if there is none, or another one.
std::string summary_of(const DataSet& data) {
  const auto file = data.find("/terrane.json");
  if (!file || file->is_gzipped) return {};
  try {
    const json summary = json::parse(file->content.read_all());
    const json& dem = summary.at("dem");
    const json& levels = summary.at("levels");
    std::int64_t tiles = 0;
    double bytes = 0;
    for (const json& level : levels) {
      tiles += level.at("tiles").get<std::int64_t>();
      bytes += level.at("bytes").get<double>();
    }
    return fmt::format(
        "{} x {} samples, {:.0f} to {:.0f} m; {} levels from {:g} m, {} tiles, {:.1f} MB",
        dem.at("columns").get<std::int64_t>(), dem.at("rows").get<std::int64_t>(),
        dem.at("min_height_m").get<double>(), dem.at("max_height_m").get<double>(), levels.size(),
        levels.at(0).at("tolerance_m").get<double>(), tiles, bytes / 1e6);
  } catch (const json::exception&) {
    return {};
  }
}

std::string link(const std::string& url, std::string_view label) {
  return fmt::format("<a href=\"{}\">{}</a>\n", escaped(url), escaped(label));
}

std::string describe(const IndexEntry& entry) {
  std::string item = fmt::format("<li><b>{}</b><br>\n", escaped(entry.name));
  if (const std::string summary = summary_of(*entry.data); !summary.empty()) {
    item += fmt::format("<small>{}</small><br>\n", escaped(summary));
  }
  if (entry.data->find("/")) item += link(entry.url + entry.data->query(), "view");
  for (const Document& document : kDocuments) {
    if (entry.data->find("/" + std::string(document.file))) {
      item += link(entry.url + std::string(document.file), document.label);
    }
  }
  const std::string& archive = entry.data->archive_name();
  if (!archive.empty()) item += link(entry.url + encode_url_path(archive), archive);
  return item + "</li>\n";
}

}  // namespace

std::string make_index_page(const std::vector<IndexEntry>& entries) {
  std::string page(kHead);
  for (const IndexEntry& entry : entries) page += describe(entry);
  return page + "</ul>\n</html>\n";
}

}  // namespace terrane::viewer
