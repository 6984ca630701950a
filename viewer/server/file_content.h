#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "viewer/server/byte_range.h"
#include "viewer/server/served_file.h"

namespace terrane::viewer {

/// Bytes that can be sent: a part of an open file, or of a text in memory. Cheap to copy.
class FileContent {
 public:
  FileContent() = default;
  FileContent(std::shared_ptr<const OpenFile> file, ByteRange part)
      : file_(std::move(file)), part_(part) {}
  explicit FileContent(std::shared_ptr<const std::string> text)
      : text_(std::move(text)), part_{0, text_->size()} {}
  explicit FileContent(std::string text)
      : FileContent(std::make_shared<const std::string>(std::move(text))) {}

  std::uint64_t bytes() const { return part_.length; }

  /// \pre the range lies in [0, bytes()).
  FileContent part(const ByteRange& range) const {
    FileContent content = *this;
    content.part_ = {part_.offset + range.offset, range.length};
    return content;
  }

  /// Reads at most `length` bytes from `offset`; fewer at the end or on failure.
  std::string read(std::uint64_t offset, std::uint64_t length) const {
    if (offset >= part_.length) return {};
    const std::uint64_t there = std::min(length, part_.length - offset);
    if (file_) return file_->read(part_.offset + offset, there);
    return text_->substr(part_.offset + offset, there);
  }
  std::string read_all() const { return read(0, bytes()); }

  /// The open file, if it is one; its part begins at offset().
  const OpenFile* file() const { return file_.get(); }
  /// The whole text, if it is one.
  const std::shared_ptr<const std::string>& text() const { return text_; }
  std::uint64_t offset() const { return part_.offset; }

 private:
  std::shared_ptr<const OpenFile> file_;
  std::shared_ptr<const std::string> text_;
  ByteRange part_;
};

}  // namespace terrane::viewer
