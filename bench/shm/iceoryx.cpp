// SPDX-License-Identifier: MIT
// shm_iceoryx READERS threads|processes RECORDS: runs the load of throughput.hpp through iceoryx 2.0 publish/subscribe,
// whose publisher blocks while a subscriber's queue is full. Needs a running iox-roudi.
#include <sched.h>

#include <iceoryx_posh/popo/publisher.hpp>
#include <iceoryx_posh/popo/subscriber.hpp>
#include <iceoryx_posh/runtime/posh_runtime.hpp>
#include <memory>
#include <string>
#include <string_view>

#include "throughput.hpp"

using namespace mavloom;
using namespace mavloom::bench;

namespace {

struct Bytes {
    std::uint8_t bytes[NumberedRecords::bytes];
};
const iox::capro::ServiceDescription service{"mavloom", "bench", "records"};

class IceoryxTransport {
public:
    explicit IceoryxTransport(bool processes) : processes_(processes) {
        if (!processes) register_as("bench");
    }

    class Writer {
    public:
        Writer() : publisher_(std::make_unique<iox::popo::Publisher<Bytes>>(service, options())) {}
        template <class Shared>
        void write(const Shared&, ByteView record) {
            publisher_->loan()
                .and_then([&](auto& sample) {
                    std::memcpy(sample->bytes, record.data(), record.size());
                    sample.publish();
                })
                .or_else([](const auto&) { std::abort(); });
        }
        template <class Shared>
        void flush(const Shared&) {}

    private:
        static iox::popo::PublisherOptions options() {
            iox::popo::PublisherOptions options;
            options.subscriberTooSlowPolicy = iox::popo::ConsumerTooSlowPolicy::WAIT_FOR_CONSUMER;
            return options;
        }
        std::unique_ptr<iox::popo::Publisher<Bytes>> publisher_;
    };

    class Reader {
    public:
        Reader() : subscriber_(std::make_unique<iox::popo::Subscriber<Bytes>>(service, options())) {
            while (subscriber_->getSubscriptionState() != iox::SubscribeState::SUBSCRIBED) ::usleep(1000);
        }
        template <class Each>
        void poll(Each&& each) {
            const auto sample = subscriber_->take();
            if (sample.has_error()) ::sched_yield();
            else each(ByteView((*sample)->bytes, sizeof(Bytes)));
        }

    private:
        static iox::popo::SubscriberOptions options() {
            iox::popo::SubscriberOptions options;
            options.queueCapacity = 256;
            options.queueFullPolicy = iox::popo::QueueFullPolicy::BLOCK_PRODUCER;
            return options;
        }
        std::unique_ptr<iox::popo::Subscriber<Bytes>> subscriber_;
    };

    [[nodiscard]] Writer writer() const {
        if (processes_) register_as("writer");
        return {};
    }
    [[nodiscard]] Reader reader(unsigned number) const {
        if (processes_) register_as("reader" + std::to_string(number));
        return {};
    }

private:
    static void register_as(const std::string& name) {
        iox::runtime::PoshRuntime::initRuntime(iox::RuntimeName_t(iox::cxx::TruncateToCapacity, "mavloom-" + name));
    }
    bool processes_;
};

}  // namespace

int main(int argc, char** argv) {
    if (argc != 4) return 2;
    const Plan plan{.readers = static_cast<unsigned>(std::atoi(argv[1])),
                    .processes = std::string_view(argv[2]) == "processes",
                    .records = std::strtoull(argv[3], nullptr, 10),
                    .before = 10'000};
    IceoryxTransport transport(plan.processes);
    measure(transport, NumberedRecords(), plan);
    return 0;
}
