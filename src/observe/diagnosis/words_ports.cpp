// SPDX-License-Identifier: MIT
// Sources, ports, and frames that cannot be read.
#include <fmt/format.h>

#include "mavloom/base/counted.hpp"
#include "observe/diagnosis/word_parts.hpp"
#include "observe/diagnosis/words.hpp"

namespace mavloom::observe::words {

using Severity = Finding::Severity;

Finding port_taken(const Listened& source) {
    auto finding = of_source("port-taken", Severity::error, source);
    finding.what = fmt::format("It cannot be opened: {}.", source.refusal);
    finding.why = "Only one program can receive on a port, or read a device.";
    finding.remedy =
        "End the other program, or let `mavloom route` have the port and give each program an udpout:// of its own.";
    return finding;
}

Finding cannot_open(const Listened& source) {
    auto finding = of_source("cannot-open", Severity::error, source);
    finding.what = fmt::format("It cannot be opened: {}.", source.refusal);
    finding.remedy = "Check the address, the path and the permissions.";
    return finding;
}

Finding port_refused(const Listened& source) {
    auto finding = of_source("port-refused", Severity::error, source);
    finding.what = source.failure.empty() ? "The host answers, and its port is closed (ICMP)."
                                          : fmt::format("The host answers, and its port is closed: {}.", source.failure);
    finding.why = "No program listens there, or a firewall rejects what comes.";
    finding.remedy = "Start the program at the far side, or correct the port.";
    return finding;
}

Finding port_refused(const Hop& hop, const HopLink& link, std::uint64_t frames) {
    Finding finding{.id = "port-refused",
                    .severity = Severity::error,
                    .where = fmt::format("{}: {}", hop.name, link.name),
                    .link = link.name};
    finding.what = fmt::format("{} met a closed port, or a host that is gone.", counted(frames, "frame"));
    finding.why = "Nobody gets what this link sends.";
    finding.remedy = "Start the program at the far side, bring its host back, or remove the endpoint.";
    return finding;
}

Finding not_connected(const Listened& source) {
    auto finding = of_source("not-connected", Severity::error, source);
    finding.what = fmt::format("It is not connected: {}.", source.failure);
    finding.remedy = source.kind == Listened::Kind::serial
                         ? "Plug the device in, or check its name and your permissions."
                         : "Check the address, the network and the far side.";
    return finding;
}

Finding nothing_heard(const Evidence& evidence, const Listened& source) {
    using Kind = Listened::Kind;
    auto finding = of_source("nothing-heard", Severity::error, source);
    const auto time = fmt::format("{:.0f} s", evidence.seconds());
    switch (source.kind) {
        case Kind::recording:
            finding.what = "The recording holds no frames.";
            finding.remedy = "Check that it was recorded where frames arrive.";
            return finding;
        case Kind::ring:
            finding.what = source.is_up ? fmt::format("Its writer wrote nothing for {}.", time)
                                        : fmt::format("No program wrote to this ring for {}.", time);
            finding.why = source.is_up ? "The writer runs, but hears nothing itself."
                                       : "The ring does not exist, or its writer has ended.";
            finding.remedy = source.is_up
                                 ? "Run `mavloom doctor` on the links of the writer."
                                 : "Start its writer, such as `mavloom route --ring`; `mavloom shm list` lists "
                                   "the rings there are.";
            return finding;
        case Kind::listens: finding.what = fmt::format("The port is open, and not one byte came in {}.", time); break;
        case Kind::calls: finding.what = fmt::format("Nothing came back in {}.", time); break;
        case Kind::serial: finding.what = fmt::format("The device is open, and not one byte came in {}.", time); break;
    }
    finding.remedy = fmt::format("Check: {}", source.silence);
    return finding;
}

Finding nothing_heard(const Evidence& evidence) {
    Finding finding{.id = "nothing-heard", .severity = Severity::error, .where = "this machine"};
    std::string tried;
    for (const auto& source : evidence.sources)
        tried += (tried.empty() ? "" : ", ") + source.name + (source.refusal.empty() ? "" : " (not open)");
    finding.what = fmt::format("Nothing was heard in {:.0f} s.", evidence.seconds());
    finding.why = fmt::format("There is no ring with a writer. These were tried: {}.", tried);
    finding.remedy =
        "Name the source: `mavloom doctor serial:///dev/ttyACM0?baud=57600`, or the port to which the vehicle sends.";
    return finding;
}

Finding wrong_baud(const Listened& source, std::uint64_t bytes) {
    auto finding = of_source("wrong-baud", Severity::error, source);
    finding.what = fmt::format("{} came, and no frame.", counted(bytes, "byte"));
    finding.why = fmt::format(
        "At a wrong baud rate, frames become junk. Here it is {}.",
        source.baud == 0 ? std::string("baud=auto, and none of the list fits") : fmt::format("{}", source.baud));
    finding.remedy =
        "Try baud=auto. On PX4 the rate is the parameter SER_TEL1_BAUD or that of the port in use, on ArduPilot "
        "SERIALn_BAUD. If it is right, check that the port speaks MAVLink (MAV_1_CONFIG, SERIALn_PROTOCOL).";
    return finding;
}

Finding not_mavlink(const Listened& source, std::uint64_t bytes) {
    auto finding = of_source("not-mavlink", Severity::error, source);
    finding.what = fmt::format("{} came, and no frame.", counted(bytes, "byte"));
    finding.why = "Another protocol uses this port, or a program on the way changes the bytes.";
    finding.remedy = "Check the port. If the definitions of the sender are not built in, add them with --dialect.";
    return finding;
}

Finding long_datagrams(const Listened& source, std::uint64_t count) {
    auto finding = of_source("long-datagrams", Severity::warning, source);
    finding.what = fmt::format("{} had more than 1472 bytes.", counted(count, "datagram"));
    finding.why =
        "An Ethernet or Wi-Fi packet carries 1472 bytes (MTU 1500). Longer datagrams travel in fragments; if one "
        "fragment is lost, all frames of the datagram are.";
    finding.remedy = "Make the sender's datagrams shorter: mtu=1280 for Mavloom; over VPN or LTE less, such as 1200.";
    return finding;
}

Finding damaged_frames(const Listened& source, std::uint64_t damaged, std::uint64_t good) {
    auto finding = of_source("damaged-frames", Severity::warning, source);
    finding.what = fmt::format("{} had a wrong checksum, beside {} good ones.", counted(damaged, "frame"), good);
    finding.why = source.kind == Listened::Kind::serial
                      ? "The line is noisy, too long, or drops bytes because it has no flow control."
                      : "A program or a radio before this machine cuts or damages frames.";
    finding.remedy = source.kind == Listened::Kind::serial
                         ? "Check the cable and its ground, lower the baud rate, or connect RTS and CTS (flow=rtscts)."
                         : "Compare with a source before that hop: `mavloom doctor A B`.";
    return finding;
}

Finding damaged_recording(const Listened& source, std::uint64_t places) {
    auto finding = of_source("damaged-recording", Severity::warning, source);
    finding.what = fmt::format("The recording is damaged in {}.", counted(places, "place"));
    finding.why = "Its writer was interrupted, the disk was full, or the file was cut.";
    finding.remedy = "The rest is read as usual. `mavloom info` lists what it holds.";
    return finding;
}

Finding wrong_dialect(const std::string& link, std::span<const WrongMessage> messages) {
    Finding finding{.id = "wrong-dialect", .where = link, .link = link, .message = messages.front().id};
    std::string unknown, different;
    for (const auto& one : messages) {
        auto& list = one.name.empty() ? unknown : different;
        list += fmt::format("{}{} ({} times)", list.empty() ? "" : ", ",
                            one.name.empty() ? fmt::format("#{}", one.id.value) : std::string(one.name), one.count);
    }
    if (!different.empty())
        finding.what = fmt::format("No frame of these messages has a good checksum: {}.", different);
    if (!unknown.empty())
        finding.what += fmt::format("{}No definition is known here of {}.", different.empty() ? "" : " ", unknown);
    finding.why = "The sender uses another dialect, or another version of the definitions.";
    finding.remedy = "Add the sender's definitions with --dialect FILE.xml. A router forwards such frames anyway.";
    return finding;
}

}  // namespace mavloom::observe::words
