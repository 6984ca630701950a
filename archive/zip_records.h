#pragma once

#include <cstdint>
#include <string_view>

namespace terrane::archive {

/// Signatures and sizes of ZIP records (PKWARE APPNOTE 6.3.10, section 4.3).
namespace zip {

inline constexpr std::uint32_t kLocalHeader = 0x04034b50;
inline constexpr std::uint32_t kCentralHeader = 0x02014b50;
inline constexpr std::uint32_t kEnd = 0x06054b50;
inline constexpr std::uint32_t kEnd64 = 0x06064b50;
inline constexpr std::uint32_t kEnd64Locator = 0x07064b50;

inline constexpr std::size_t kLocalHeaderBytes = 30;
inline constexpr std::size_t kCentralHeaderBytes = 46;
inline constexpr std::size_t kEndBytes = 22;
inline constexpr std::size_t kEnd64Bytes = 56;
inline constexpr std::size_t kEnd64LocatorBytes = 20;

inline constexpr std::uint16_t kExtraZip64 = 0x0001;
inline constexpr std::uint16_t kMethodStored = 0;
inline constexpr std::uint16_t kMethodDeflated = 8;
inline constexpr std::uint32_t kIsInExtra = 0xffffffff;
inline constexpr std::uint16_t kManyEntries = 0xffff;

/// The index of a 3tz: its last file.
inline constexpr std::string_view kIndexName = "@3dtilesIndex1@";

}  // namespace zip
}  // namespace terrane::archive
