#pragma once

#include <string>
#include <string_view>

#include "hierarchy/merge/merge_tree.h"

namespace terrane::hierarchy {

/// The bytes of a tree: the coarsest mesh, then the merges from coarse to fine in blocks that each
/// have a checksum. docs/formats.md describes them.
std::string encode_tree(const MergeTree& tree);

/// What to make of bytes that end early.
enum class TreeEnd : std::uint8_t {
  kComplete,  ///< refuse them
  kAnywhere,  ///< read the blocks that are whole: a coarser tree, with the bounds of the whole one
};

/// Reads a tree. Every merge is checked against the mesh that it belongs to.
/// \param file  named in messages.
/// \throws InputError if the bytes are no tree of this version, or damaged.
MergeTree decode_tree(std::string_view bytes, const std::string& file,
                      TreeEnd end = TreeEnd::kComplete);

}  // namespace terrane::hierarchy
