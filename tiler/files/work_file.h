#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <type_traits>
#include <vector>

namespace terrane::tiler {

/// Collects plain values and writes them to a file that only the same build, on the same machine,
/// will read: as they lie in memory.
class WorkFileWriter {
 public:
  template <class T>
  void add(const T& value) {
    append(&value, sizeof(T));
  }
  template <class T>
  void add(const std::vector<T>& values) {
    add(std::uint64_t{values.size()});
    append(values.data(), values.size() * sizeof(T));
  }

  /// \throws OutputError if the file cannot be written.
  void write(const std::filesystem::path& file) const;

 private:
  void append(const void* from, std::size_t size) {
    bytes_.append(static_cast<const char*>(from), size);
  }

  std::string bytes_;
};

/// Gives the values back in the same order.
class WorkFileReader {
 public:
  /// \throws InputError if the file is not there.
  explicit WorkFileReader(const std::filesystem::path& file);

  /// \throws InputError if the file is cut short.
  template <class T>
  T get() {
    T value;
    take(&value, sizeof(T));
    return value;
  }
  template <class T>
  std::vector<T> get_vector() {
    const auto size = get<std::uint64_t>();
    if (size > (bytes_.size() - at_) / sizeof(T)) refuse();
    std::vector<T> values(size);
    take(values.data(), size * sizeof(T));
    return values;
  }

  /// \throws InputError that says what to do about a damaged file.
  [[noreturn]] void refuse() const;

 private:
  void take(void* target, std::size_t size);

  std::string name_;
  std::string bytes_;
  std::size_t at_ = 0;
};

}  // namespace terrane::tiler
