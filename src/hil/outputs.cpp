// SPDX-License-Identifier: MIT
#include "hil/outputs.hpp"

#include <algorithm>
#include <cmath>

namespace mavloom::hil {

namespace {

// Indices of the controls: those of MAIN1 to MAIN16, less one.
struct PlaneControls {
    static constexpr std::size_t rudder = 2, motor = 4, left_aileron = 5, right_aileron = 6, elevator = 7;
};
struct RoverControls {
    static constexpr std::size_t steering = 0, drive = 5;
};

class Reader {
public:
    explicit Reader(const Controls& controls) : controls_(controls) {}

    [[nodiscard]] double motor(std::size_t index) { return within(index, 0); }
    // Also a motor that can reverse.
    [[nodiscard]] double servo(std::size_t index) { return within(index, -1); }
    [[nodiscard]] ReadOutputs result(const flight::Outputs& outputs) {
        read_.outputs = outputs;
        return read_;
    }

private:
    double within(std::size_t index, double least) {
        const auto value = static_cast<double>(controls_[index]);
        if (!std::isfinite(value)) {
            read_.has_no_number = true;
            return 0;
        }
        read_.has_beyond |= value < least || value > 1;
        return std::clamp(value, least, 1.0);
    }

    const Controls& controls_;
    ReadOutputs read_;
};

ReadOutputs read_motors(Reader reader, const flight::Channels& channels) {
    flight::Outputs outputs{};
    for (std::size_t i = 0; i < channels.used; ++i) outputs[i] = reader.motor(i);
    return reader.result(outputs);
}

// A positive output lifts the rear edge of its aileron, which lowers that wing, and that of the elevator. The rudder
// moves to the right.
ReadOutputs read_plane(Reader reader) {
    using From = PlaneControls;
    const double aileron = (reader.servo(From::right_aileron) - reader.servo(From::left_aileron)) / 2;
    const double elevator = reader.servo(From::elevator), motor = reader.motor(From::motor);
    return reader.result({aileron, elevator, motor, reader.servo(From::rudder)});
}

ReadOutputs read_rover(Reader reader) {
    const double drive = reader.servo(RoverControls::drive);
    return reader.result({drive, reader.servo(RoverControls::steering)});
}

}  // namespace

ReadOutputs read_outputs(const Controls& controls, flight::Kind kind, const flight::Channels& channels) {
    const Reader reader(controls);
    switch (kind) {
        case flight::Kind::plane: return read_plane(reader);
        case flight::Kind::rover: return read_rover(reader);
        case flight::Kind::quad: break;
    }
    return read_motors(reader, channels);
}

}  // namespace mavloom::hil
