// SPDX-License-Identifier: MIT
#include "mavloom/wire/crc.hpp"

#if defined(__x86_64__)
#include <immintrin.h>

#include <limits>
#endif

namespace mavloom::wire {

namespace {

// Slicing-by-8: processes eight bytes at a time, whose contributions are independent, then the rest byte by byte.
std::uint16_t update_portable(std::uint16_t crc, const std::uint8_t* p, std::size_t size) noexcept {
    const auto& t = detail::crc_slices;
    for (; size >= 8; p += 8, size -= 8) {
        crc = static_cast<std::uint16_t>(t[7][(p[0] ^ crc) & 0xff] ^ t[6][p[1] ^ (crc >> 8)] ^ t[5][p[2]] ^ t[4][p[3]] ^
                                         t[3][p[4]] ^ t[2][p[5]] ^ t[1][p[6]] ^ t[0][p[7]]);
    }
    for (; size > 0; ++p, --size) crc = crc_update(crc, *p);
    return crc;
}

bool agrees(std::uint16_t before, std::uint32_t tail) noexcept {
    return crc_update(before, static_cast<std::uint8_t>(tail)) == tail >> 8;
}

bool check_portable(std::uint32_t tail, const std::uint8_t* p, std::size_t size, std::size_t) noexcept {
    return agrees(update_portable(crc_seed, p, size), tail);
}

#if defined(__x86_64__)

// Polynomials are reflected: bit i of a 64-bit word stands for x^(63-i), so a little-endian load needs no byte swap.
// The carry-less product of two such words comes out multiplied by x. The exponents below are therefore one less than
// the distance folded.
// P = x^16 + x^12 + x^5 + 1.
// Method: Gopal et al., "Fast CRC Computation for Generic Polynomials Using PCLMULQDQ" (Intel, 2009).
constexpr std::uint64_t x575_mod_p = 0x9822000000000000;
constexpr std::uint64_t x511_mod_p = 0x7f90000000000000;
constexpr std::uint64_t x447_mod_p = 0x5159000000000000;
constexpr std::uint64_t x383_mod_p = 0x8f66000000000000;
constexpr std::uint64_t x319_mod_p = 0xaac8000000000000;
constexpr std::uint64_t x255_mod_p = 0x20f3000000000000;
constexpr std::uint64_t x191_mod_p = 0xa95d000000000000;
constexpr std::uint64_t x127_mod_p = 0x7eea000000000000;
constexpr std::uint64_t x63_mod_p = 0x042b000000000000;
constexpr std::uint64_t barrett_mu = 0xc2cd82058e2c0c88;    // floor(x^80 / P) without its leading x^64
constexpr std::uint64_t inverse_of_p = 0x84298ae61426656b;  // modulo x^64

// A pshufb mask: shift_in[n .. n+16) moves the first n bytes of a block to its end and fills the rest with zeros.
// pshufb writes 0 for an index whose high bit is set.
alignas(64) constexpr std::uint8_t shift_in[32] = {0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80,
                                                   0x80, 0x80, 0x80, 0x80, 0x80, 0,    1,    2,    3,    4,    5,
                                                   6,    7,    8,    9,    10,   11,   12,   13,   14,   15};

#define MAVLOOM_CLMUL [[gnu::target("pclmul,avx")]]

MAVLOOM_CLMUL inline __m128i load(const std::uint8_t* p) noexcept {
    return _mm_loadu_si128(reinterpret_cast<const __m128i*>(p));
}

// Moves a block further from the end of the message. `by` holds the powers of x for its first and its last eight bytes.
MAVLOOM_CLMUL inline __m128i fold(__m128i block, __m128i by) noexcept {
    return _mm_xor_si128(_mm_clmulepi64_si128(block, by, 0x00), _mm_clmulepi64_si128(block, by, 0x11));
}

MAVLOOM_CLMUL inline __m128i powers(std::uint64_t first, std::uint64_t last) noexcept {
    return _mm_set_epi64x(static_cast<long long>(last), static_cast<long long>(first));
}

// Folds the first eight bytes of a block onto the last eight. 80 bits remain.
MAVLOOM_CLMUL inline __m128i fold_half(__m128i block) noexcept {
    return _mm_xor_si128(_mm_clmulepi64_si128(block, powers(x63_mod_p, 0), 0x00),
                         _mm_and_si128(block, _mm_set_epi64x(-1, 0)));
}

// Returns block * x^16 mod P.
MAVLOOM_CLMUL inline std::uint16_t reduce(__m128i block) noexcept {
    block = fold_half(fold_half(block));
    const auto rest = static_cast<std::uint64_t>(_mm_extract_epi64(block, 1));
    const __m128i product = _mm_clmulepi64_si128(block, powers(barrett_mu, 0), 0x01);
    const std::uint64_t quotient = rest ^ (static_cast<std::uint64_t>(_mm_cvtsi128_si64(product)) << 1);
    const auto q = static_cast<std::uint32_t>(quotient >> 48);
    return static_cast<std::uint16_t>(q ^ (q >> 5) ^ (q >> 12));
}

// Leading zeros do not change the remainder. So the first size % 16 bytes become the end of a block of zeros, and whole
// blocks follow.
MAVLOOM_CLMUL std::uint16_t update_pclmul(std::uint16_t crc, const std::uint8_t* p, std::size_t size) noexcept {
    // The old checksum is xored into the first two bytes, so a head of one byte is too short.
    if (size % 16 == 1) {
        crc = crc_update(crc, *p);
        ++p;
        --size;
    }
    if (size < 16) return update_portable(crc, p, size);
    const std::size_t head = size % 16 == 0 ? 16 : size % 16;
    const auto* const end = p + size;
    __m128i block = _mm_shuffle_epi8(_mm_xor_si128(load(p), _mm_cvtsi32_si128(crc)), load(shift_in + head));
    const __m128i by_128 = powers(x191_mod_p, x127_mod_p);
    for (p += head; p != end; p += 16) block = _mm_xor_si128(fold(block, by_128), load(p));
    return reduce(block);
}

constexpr std::size_t group = 64;

// keep[group - n .. 2 * group - n) is the mask that keeps the first n bytes of a group.
consteval std::array<std::uint8_t, 2 * group> make_keep() {
    std::array<std::uint8_t, 2 * group> keep{};
    for (std::size_t i = 0; i < group; ++i) keep[i] = 0xff;
    return keep;
}
alignas(64) constexpr auto keep = make_keep();

// weights[n] moves a value to the place behind n bytes of a zero-filled group: x^(8 * (group - n) - 64).
// The exponent is one less because the product is multiplied by x. The lowest byte of a word comes first.
// Negative powers exist because P has a constant term, so x has an inverse modulo P.
consteval std::array<std::uint64_t, group + 2> make_weights() {
    std::array<std::uint64_t, group + 2> weights{};
    for (std::size_t n = 0; n <= group; ++n) {
        unsigned power = 0x8000;  // x^0
        int exponent = 8 * static_cast<int>(group - n) - 64 - 1;
        for (; exponent > 0; --exponent) power = power >> 1 ^ ((power & 1) != 0 ? 0x8408u : 0u);
        for (; exponent < 0; ++exponent) power = (power & 0x8000) != 0 ? (power ^ 0x8408u) << 1 | 1u : power << 1;
        weights[n] = std::uint64_t{power} << 48;
    }
    return weights;
}
alignas(64) constexpr auto weights = make_weights();

struct Groups {
    __m128i a, b, c, d;
};

MAVLOOM_CLMUL inline void add(Groups& sum, const std::uint8_t* p) noexcept {
    sum.a = _mm_xor_si128(sum.a, load(p));
    sum.b = _mm_xor_si128(sum.b, load(p + 16));
    sum.c = _mm_xor_si128(sum.c, load(p + 32));
    sum.d = _mm_xor_si128(sum.d, load(p + 48));
}

MAVLOOM_CLMUL inline void add_masked(Groups& sum, const std::uint8_t* p, const std::uint8_t* mask) noexcept {
    sum.a = _mm_xor_si128(sum.a, _mm_and_si128(load(p), load(mask)));
    sum.b = _mm_xor_si128(sum.b, _mm_and_si128(load(p + 16), load(mask + 16)));
    sum.c = _mm_xor_si128(sum.c, _mm_and_si128(load(p + 32), load(mask + 32)));
    sum.d = _mm_xor_si128(sum.d, _mm_and_si128(load(p + 48), load(mask + 48)));
}

MAVLOOM_CLMUL inline void fold_group(Groups& sum) noexcept {
    const __m128i by_512 = powers(x575_mod_p, x511_mod_p);
    sum = {fold(sum.a, by_512), fold(sum.b, by_512), fold(sum.c, by_512), fold(sum.d, by_512)};
}

// True if the 80-bit polynomial `value`, with its low 64 bits in the last eight bytes, is a multiple of P.
// Folds the polynomial, then divides it by P from the low end, as if the division were exact.
// It is a multiple if the quotient has no terms above x^47.
MAVLOOM_CLMUL inline bool is_multiple_of_p(__m128i value) noexcept {
    const __m128i by = powers(x63_mod_p, inverse_of_p);
    value = _mm_xor_si128(value, _mm_clmulepi64_si128(value, by, 0x00));
    const __m128i quotient = _mm_clmulepi64_si128(value, by, 0x11);
    const __m128i x48_to_x63 = _mm_set_epi64x(0x7fff, std::numeric_limits<long long>::min());
    return _mm_testz_si128(quotient, x48_to_x63) != 0;
}

// A message followed by CRC_EXTRA and its own checksum leaves no remainder, and zeros behind it change nothing.
// So all lengths up to a group take the same time, without a branch, and the remainder need not be computed.
MAVLOOM_CLMUL bool check_pclmul(std::uint32_t tail, const std::uint8_t* p, std::size_t size,
                                std::size_t readable) noexcept {
    if (((size + group - 1) & ~(group - 1)) > readable) return agrees(update_pclmul(crc_seed, p, size), tail);
    Groups sum{_mm_cvtsi32_si128(crc_seed), _mm_setzero_si128(), _mm_setzero_si128(), _mm_setzero_si128()};
    for (; size > group; size -= group, p += group) {
        add(sum, p);
        fold_group(sum);
    }
    add_masked(sum, p, keep.data() + group - size);
    const __m128i checksum = _mm_clmulepi64_si128(_mm_cvtsi32_si128(static_cast<int>(tail)),
                                                  _mm_loadl_epi64(reinterpret_cast<const __m128i*>(&weights[size])), 0);
    const __m128i ab = _mm_xor_si128(fold(sum.a, powers(x447_mod_p, x383_mod_p)),
                                     fold(sum.b, powers(x319_mod_p, x255_mod_p)));
    const __m128i cd = _mm_xor_si128(fold(sum.c, powers(x191_mod_p, x127_mod_p)), fold_half(sum.d));
    return is_multiple_of_p(_mm_xor_si128(_mm_xor_si128(ab, cd), checksum));
}

const CrcImplementation implementations[] = {{"portable", update_portable, check_portable},
                                             {"pclmul", update_pclmul, check_pclmul}};

std::size_t usable() noexcept { return __builtin_cpu_supports("pclmul") && __builtin_cpu_supports("avx") ? 2 : 1; }

#else

const CrcImplementation implementations[] = {{"portable", update_portable, check_portable}};

std::size_t usable() noexcept { return 1; }

#endif

}  // namespace

const CrcImplementation detail::crc_fastest = implementations[usable() - 1];

std::span<const CrcImplementation> crc_implementations() noexcept { return {implementations, usable()}; }

int crc_extra_between(std::uint16_t before, std::uint16_t received) noexcept {
    const unsigned extra = before ^ crc_before(received, 0);
    return extra < 256 ? static_cast<int>(extra) : -1;
}

}  // namespace mavloom::wire
