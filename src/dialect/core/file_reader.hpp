// SPDX-License-Identifier: MIT
// Turns one XML file into definitions. Strict: an element that it does not know where layout depends on elements, a missing attribute or a
// value of the wrong form is an error with its line. Attributes that it has no use for are passed over, as are all descriptions.
// Source: MAVLink's XSD (mavschema.xsd) and its generator's reading of it (pymavlink, mavparse.py).
#pragma once

#include "definitions.hpp"
#include "records.hpp"
#include "source_file.hpp"

namespace mavloom::dialect {

[[nodiscard]] SetupResult<FileDefinitions> read_definitions(const SourceFile& file, Records& records);

}  // namespace mavloom::dialect
