// SPDX-License-Identifier: MIT
// Runs the load of throughput.hpp through Aeron IPC, with an exclusive publication and a media driver of one shared
// thread:
//     AeronIpc threads|processes READERS RECORDS
// With `processes`, each reader is a Java process, started with `reader DIRECTORY RECORDS`. The clock stops when the last
// reader has reported that it is done. Prints the records and the seconds they took.
import io.aeron.Aeron;
import io.aeron.ExclusivePublication;
import io.aeron.Subscription;
import io.aeron.driver.MediaDriver;
import io.aeron.driver.ThreadingMode;
import io.aeron.logbuffer.BufferClaim;
import io.aeron.logbuffer.FragmentHandler;
import java.io.IOException;
import java.util.ArrayList;
import java.util.List;
import java.util.concurrent.CountDownLatch;
import org.agrona.concurrent.BackoffIdleStrategy;

public final class AeronIpc {
    private static final String CHANNEL = "aeron:ipc";
    private static final int STREAM = 1001, BYTES = 64, FRAGMENTS = 256;
    private static final long BEFORE = 5_000_000; // that the clock does not see, and the compiler does

    // Whoever reads on compares first and last word with what they must be.
    private static final class Reader {
        long next;

        void read(Subscription subscription, long records) {
            final FragmentHandler each = (buffer, offset, length, header) -> {
                if (length != BYTES || buffer.getLong(offset) != next || buffer.getLong(offset + BYTES - 8) != ~next) {
                    System.err.println("record " + next + " is not what was written");
                    System.exit(1);
                }
                next++;
            };
            while (next < records) if (subscription.poll(each, FRAGMENTS) == 0) Thread.yield();
        }
    }

    private static void write(ExclusivePublication publication, long first, long end) {
        final BufferClaim claim = new BufferClaim();
        for (long number = first; number < end; number++) {
            while (publication.tryClaim(BYTES, claim) < 0) Thread.yield();
            claim.buffer().putLong(claim.offset(), number);
            for (int i = 1; i < BYTES / 8 - 1; i++) claim.buffer().putLong(claim.offset() + i * 8, 0);
            claim.buffer().putLong(claim.offset() + BYTES - 8, ~number);
            claim.commit();
        }
    }

    private interface Readers {
        void waitFor(int phase) throws Exception;
    }

    private static Readers inThreads(Aeron aeron, int count, long records) {
        final CountDownLatch[] passed = {new CountDownLatch(count), new CountDownLatch(count)};
        for (int i = 0; i < count; i++) {
            final Subscription subscription = aeron.addSubscription(CHANNEL, STREAM);
            new Thread(() -> {
                final Reader reader = new Reader();
                reader.read(subscription, BEFORE);
                passed[0].countDown();
                reader.read(subscription, BEFORE + records);
                passed[1].countDown();
            }).start();
        }
        return phase -> passed[phase].await();
    }

    private static Readers inProcesses(String directory, int count, long records) throws IOException {
        final List<Process> readers = new ArrayList<>();
        for (int i = 0; i < count; i++)
            readers.add(new ProcessBuilder(ProcessHandle.current().info().command().get(), "-cp", System.getProperty("java.class.path"),
                "--add-opens", "java.base/jdk.internal.misc=ALL-UNNAMED", "--add-opens", "java.base/sun.nio.ch=ALL-UNNAMED",
                "AeronIpc", "reader", directory, Long.toString(records)).redirectError(ProcessBuilder.Redirect.INHERIT).start());
        return phase -> {
            for (final Process reader : readers) if (reader.getInputStream().read() != '0' + phase) System.exit(1);
        };
    }

    private static void beReader(String directory, long records) {
        try (Aeron aeron = Aeron.connect(new Aeron.Context().aeronDirectoryName(directory));
             Subscription subscription = aeron.addSubscription(CHANNEL, STREAM)) {
            final Reader reader = new Reader();
            reader.read(subscription, BEFORE);
            System.out.print('0');
            System.out.flush();
            reader.read(subscription, BEFORE + records);
            System.out.print('1');
            System.out.flush();
        }
    }

    public static void main(String[] arguments) throws Exception {
        final long records = Long.parseLong(arguments[2]);
        if (arguments[0].equals("reader")) {
            beReader(arguments[1], records);
            return;
        }
        final int count = Integer.parseInt(arguments[1]);
        final MediaDriver.Context context = new MediaDriver.Context().threadingMode(ThreadingMode.SHARED).dirDeleteOnStart(true)
            .sharedIdleStrategy(new BackoffIdleStrategy()).dirDeleteOnShutdown(true)
            .aeronDirectoryName("/dev/shm/aeron-mavloom-bench-" + ProcessHandle.current().pid());
        try (MediaDriver driver = MediaDriver.launchEmbedded(context);
             Aeron aeron = Aeron.connect(new Aeron.Context().aeronDirectoryName(driver.aeronDirectoryName()));
             ExclusivePublication publication = aeron.addExclusivePublication(CHANNEL, STREAM)) {
            final Readers readers = arguments[0].equals("threads") ? inThreads(aeron, count, records)
                : inProcesses(driver.aeronDirectoryName(), count, records);
            while (connectedReaders(aeron, publication) < count) Thread.sleep(10);
            write(publication, 0, BEFORE);
            readers.waitFor(0);
            final long start = System.nanoTime();
            write(publication, BEFORE, BEFORE + records);
            readers.waitFor(1);
            System.out.printf("%d %.6f%n", records, (System.nanoTime() - start) * 1e-9);
        }
    }

    // Of subscribers' positions of this publication's session (counter type 4) there is one each.
    private static int connectedReaders(Aeron aeron, ExclusivePublication publication) {
        final int[] found = {0};
        aeron.countersReader().forEach((id, type, key, label) -> {
            if (type == 4 && key.getInt(8) == publication.sessionId()) found[0]++;
        });
        return found[0];
    }
}
