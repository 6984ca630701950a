#include "tiler/verify/picture_file.h"

#include <zlib.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "tiler/verify/json_file.h"

namespace terrane::verify {
namespace {

constexpr std::size_t kChannels = 3;
constexpr std::uint32_t kMostPixels = 4096;  // along a side; a damaged number must not eat memory

class Png {
 public:
  explicit Png(const std::filesystem::path& file) : file_(file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw damaged(file, "missing or unreadable");
    content_.assign(std::istreambuf_iterator<char>(stream), {});
  }

  Picture decode() {
    constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n";
    if (!content_.starts_with(kSignature)) throw damaged(file_, "is no PNG");
    bool has_ended = false;
    for (std::size_t at = kSignature.size(); !has_ended;) has_ended = take_chunk(at);
    Picture picture{.side_px = static_cast<int>(side_),
                    .rgb = {},
                    .bytes = static_cast<std::int64_t>(content_.size())};
    picture.rgb = without_filters(inflated());
    return picture;
  }

 private:
  std::uint32_t word(std::size_t at) const {
    std::uint32_t value = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      value = value << 8 | static_cast<unsigned char>(content_[at + k]);
    }
    return value;
  }

  /// \return true at the last one.
  bool take_chunk(std::size_t& at) {
    constexpr std::size_t kAround = 12;  // length, name and checksum
    if (content_.size() - at < kAround) throw damaged(file_, "is cut short");
    const std::size_t length = word(at);
    if (length > content_.size() - at - kAround) throw damaged(file_, "is cut short");
    const auto* begin = reinterpret_cast<const Bytef*>(content_.data() + at + 4);
    if (crc32(0, begin, static_cast<uInt>(length + 4)) != word(at + 8 + length)) {
      throw damaged(file_, "a checksum is wrong");
    }
    const std::string name = content_.substr(at + 4, 4);
    if (name == "IHDR") take_header(at + 8, length);
    if (name == "IDAT") packed_.append(content_, at + 8, length);
    at += kAround + length;
    return name == "IEND";
  }

  void take_header(std::size_t at, std::size_t length) {
    constexpr std::size_t kHeader = 13;
    // 8 bits, red green and blue, the usual compression and filters, not interlaced
    constexpr std::string_view kKind("\x08\x02\x00\x00\x00", 5);
    if (length != kHeader || word(at) != word(at + 4) || word(at) == 0 || word(at) > kMostPixels ||
        content_.compare(at + 8, 5, kKind) != 0) {
      throw damaged(file_, "is no square picture of 8 bits red, green and blue");
    }
    side_ = word(at);
  }

  /// The rows with a byte for the filter before each.
  std::string inflated() const {
    const std::size_t size = side_ * (1 + kChannels * side_);
    if (size == 0) throw damaged(file_, "has no header");
    std::string rows(size, '\0');
    auto length = static_cast<uLongf>(size);
    if (uncompress(reinterpret_cast<Bytef*>(rows.data()), &length,
                   reinterpret_cast<const Bytef*>(packed_.data()),
                   static_cast<uLong>(packed_.size())) != Z_OK ||
        length != size) {
      throw damaged(file_, "does not decompress");
    }
    return rows;
  }

  std::vector<std::uint8_t> without_filters(const std::string& rows) const {
    const std::size_t stride = kChannels * side_;
    std::vector<std::uint8_t> rgb(side_ * stride);
    for (std::size_t row = 0; row < side_; ++row) {
      const char* line = rows.data() + row * (stride + 1);
      for (std::size_t i = 0; i < stride; ++i) {
        const std::size_t at = row * stride + i;
        const int left = i < kChannels ? 0 : rgb[at - kChannels],
                  up = row == 0 ? 0 : rgb[at - stride];
        const int corner = i < kChannels || row == 0 ? 0 : rgb[at - stride - kChannels];
        const int guess = predicted(line[0], left, up, corner);
        rgb[at] = static_cast<std::uint8_t>(static_cast<unsigned char>(line[1 + i]) + guess);
      }
    }
    return rgb;
  }

  int predicted(char filter, int left, int up, int corner) const {
    enum { kNone, kSub, kUp, kAverage, kPaeth };
    switch (filter) {
      case kNone:
        return 0;
      case kSub:
        return left;
      case kUp:
        return up;
      case kAverage:
        return (left + up) / 2;
      case kPaeth: {
        const int guess = left + up - corner;
        const int to_left = std::abs(guess - left), to_up = std::abs(guess - up);
        const int to_corner = std::abs(guess - corner);
        if (to_left <= to_up && to_left <= to_corner) return left;
        return to_up <= to_corner ? up : corner;
      }
      default:
        throw damaged(file_, "has an unknown filter");
    }
  }

  const std::filesystem::path& file_;
  std::string content_, packed_;
  std::size_t side_ = 0;
};

}  // namespace

Picture read_png(const std::filesystem::path& file) { return Png(file).decode(); }

}  // namespace terrane::verify
