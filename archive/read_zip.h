#pragma once

#include <memory>

#include "archive/archive.h"

namespace terrane::archive {

/// Opens a 3tz, or any ZIP whose files are stored or deflated. The central directory is read at
/// once.
///
/// \throws InputError if it is damaged, encrypted, in several parts, or compressed in another way.
/// \par Source
/// PKWARE APPNOTE 6.3.10, sections 4.3 and 4.5.3 (ZIP64).
std::unique_ptr<Archive> read_zip(std::unique_ptr<const ArchiveFile> file);

}  // namespace terrane::archive
