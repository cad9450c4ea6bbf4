// SPDX-License-Identifier: MIT
#include "mavloom/feed/summarize.hpp"

namespace mavloom::feed {

SetupResult<Summarized> summarize(record::TlogReader& reader, observe::Summarizer& to, std::uint64_t max_bytes) {
    using Stop = record::TlogReader::Stop;
    for (const auto end = reader.position() + max_bytes; reader.position() < end;) {
        const auto record = reader.next(max_bytes);
        if (record) to.add(record->frame, record->info, record->time);
        else if (record.error() == Stop::failed) return tl::unexpected(reader.error());
        else if (record.error() == Stop::nothing_yet) return Summarized::nothing_yet;
        else if (record.error() == Stop::end && reader.found_no_record())
            return tl::unexpected(reader.no_record_error());
        else if (record.error() == Stop::end) return Summarized::all;
    }
    return Summarized::more;
}

}  // namespace mavloom::feed
