#pragma once

#include <optional>
#include <string_view>

namespace terrane::ingest {

/// The unit in which a file counts heights.
enum class VerticalUnit { kMetre, kFoot, kUsSurveyFoot };

/// Metres in one unit: 1, 0.3048 (international foot) or 1200/3937 (US survey foot).
double metres_per_unit(VerticalUnit unit);

/// The word of the command line for a unit: metre, foot or us-survey-foot.
std::string_view name_of(VerticalUnit unit);

/// Reads a word of the command line, exactly as name_of() writes it; nullopt for any other.
std::optional<VerticalUnit> parse_vertical_unit(std::string_view word);

/// Reads a unit as raster formats spell it ("m", "Metre", "ft", "US survey foot", ...), whatever
/// its case; nullopt for a unit that is none of the three.
std::optional<VerticalUnit> recognise_vertical_unit(std::string_view word_in_file);

/// Tells the unit from its length; nullopt unless it is that of one of the three to within 1e-9 m.
std::optional<VerticalUnit> recognise_vertical_unit(double length_m);

}  // namespace terrane::ingest
