#pragma once

#include <string>
#include <string_view>

#include "hierarchy/levels/level_sequence.h"

namespace terrane::hierarchy {

/// The bytes of a sequence: the coarsest mesh and the reversed collapses, as docs/formats.md says.
std::string encode_levels(const LevelSequence& sequence);

/// Reads what encode_levels() wrote; the result is equal to what was given to it.
///
/// \param file  name of the file, for messages.
/// \throws InputError if the bytes are of something else, of a later version, cut off or damaged.
LevelSequence decode_levels(std::string_view bytes, const std::string& file);

}  // namespace terrane::hierarchy
