// SPDX-License-Identifier: MIT
// Reads the definitions from one parsed XML file.
// An unknown element, a missing attribute or an invalid value is an error (`bad_input`) with file and line.
// Ignores unknown attributes, descriptions, and elements inside <field> and <param>.
// Source: MAVLink's XSD (mavschema.xsd) and pymavlink's reading of it (mavparse.py).
#pragma once

#include "definitions.hpp"
#include "records.hpp"
#include "source_file.hpp"

namespace mavloom::dialect {

[[nodiscard]] SetupResult<FileDefinitions> read_definitions(const SourceFile& file, Records& records);

}  // namespace mavloom::dialect
