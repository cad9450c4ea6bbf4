// SPDX-License-Identifier: MIT
#include "mavloom/wire/crc.hpp"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace mavloom::wire {

namespace {

// One byte at a time for the ends, eight at a time between: each byte's contribution is independent (slicing-by-8).
std::uint16_t update_portable(std::uint16_t crc, const std::uint8_t* p, std::size_t size) noexcept {
    const auto& t = detail::crc_slices;
    for (; size >= 8; p += 8, size -= 8) {
        crc = static_cast<std::uint16_t>(t[7][(p[0] ^ crc) & 0xff] ^ t[6][p[1] ^ (crc >> 8)] ^ t[5][p[2]] ^ t[4][p[3]] ^
                                         t[3][p[4]] ^ t[2][p[5]] ^ t[1][p[6]] ^ t[0][p[7]]);
    }
    for (; size > 0; ++p, --size) crc = crc_update(crc, *p);
    return crc;
}

#if defined(__x86_64__)

// Reflected polynomials: bit i of a 64-bit word stands for x^(63-i), so that a little-endian load of the message is already in order. The
// carry-less product of two such words comes out multiplied by x, hence the exponents one lower than the distance folded.
// P = x^16 + x^12 + x^5 + 1. Method: Gopal et al., "Fast CRC Computation for Generic Polynomials Using PCLMULQDQ" (Intel, 2009).
constexpr std::uint64_t x191_mod_p = 0xa95d000000000000;
constexpr std::uint64_t x127_mod_p = 0x7eea000000000000;
constexpr std::uint64_t x63_mod_p = 0x042b000000000000;
constexpr std::uint64_t barrett_mu = 0xc2cd82058e2c0c88;  // floor(x^80 / P) without its leading x^64

// shift_in[n .. n+16) moves the first n bytes of a block to its end and fills with zeros (pshufb: high bit set gives 0).
alignas(64) constexpr std::uint8_t shift_in[32] = {0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80,
                                                   0x80, 0x80, 0x80, 0x80, 0x80, 0,    1,    2,    3,    4,    5,
                                                   6,    7,    8,    9,    10,   11,   12,   13,   14,   15};

// crc = block * x^16 mod P.
[[gnu::target("pclmul,sse4.1")]] inline std::uint16_t reduce(__m128i block) noexcept {
    const __m128i fold = _mm_set_epi64x(0, static_cast<long long>(x63_mod_p));
    block = _mm_xor_si128(_mm_clmulepi64_si128(block, fold, 0x00), _mm_and_si128(block, _mm_set_epi64x(-1, 0)));
    block = _mm_xor_si128(_mm_clmulepi64_si128(block, fold, 0x00), block);
    const auto rest = static_cast<std::uint64_t>(_mm_extract_epi64(block, 1));
    const __m128i product = _mm_clmulepi64_si128(_mm_cvtsi64_si128(static_cast<long long>(rest)),
                                                 _mm_cvtsi64_si128(static_cast<long long>(barrett_mu)), 0x00);
    const std::uint64_t quotient = rest ^ (static_cast<std::uint64_t>(_mm_cvtsi128_si64(product)) << 1);
    const auto q = static_cast<std::uint32_t>(quotient >> 48);
    return static_cast<std::uint16_t>(q ^ (q >> 5) ^ (q >> 12));
}

// Leading zeros do not change a remainder: the odd bytes at the front become the end of a block that is zero before, then whole blocks follow.
[[gnu::target("pclmul,sse4.1")]] std::uint16_t update_pclmul(std::uint16_t crc, const std::uint8_t* p,
                                                             std::size_t size) noexcept {
    if (size % 16 == 1) {  // the old checksum is xored into two bytes: one would fall out of a head of one
        crc = crc_update(crc, *p);
        ++p;
        --size;
    }
    if (size < 16) return update_portable(crc, p, size);
    const std::size_t head = size % 16 == 0 ? 16 : size % 16;
    const auto* const end = p + size;
    const __m128i first = _mm_xor_si128(_mm_loadu_si128(reinterpret_cast<const __m128i*>(p)), _mm_cvtsi32_si128(crc));
    __m128i block = _mm_shuffle_epi8(first, _mm_loadu_si128(reinterpret_cast<const __m128i*>(shift_in + head)));
    const __m128i fold = _mm_set_epi64x(static_cast<long long>(x127_mod_p), static_cast<long long>(x191_mod_p));
    for (p += head; p != end; p += 16) {
        const __m128i next = _mm_loadu_si128(reinterpret_cast<const __m128i*>(p));
        block = _mm_xor_si128(
            _mm_xor_si128(_mm_clmulepi64_si128(block, fold, 0x00), _mm_clmulepi64_si128(block, fold, 0x11)), next);
    }
    return reduce(block);
}

const CrcImplementation implementations[] = {{"portable", update_portable}, {"pclmul", update_pclmul}};

std::size_t usable() noexcept { return __builtin_cpu_supports("pclmul") && __builtin_cpu_supports("sse4.1") ? 2 : 1; }

#else

const CrcImplementation implementations[] = {{"portable", update_portable}};

std::size_t usable() noexcept { return 1; }

#endif

// inverse_high[h]: the index whose table entry has the high byte h. The 256 high bytes are all different (a test says so).
consteval std::array<std::uint8_t, 256> make_inverse_high() {
    std::array<std::uint8_t, 256> inverse{};
    for (unsigned i = 0; i < 256; ++i) inverse[detail::crc_slices[0][i] >> 8] = static_cast<std::uint8_t>(i);
    return inverse;
}
constexpr auto inverse_high = make_inverse_high();

}  // namespace

const detail::CrcFunction detail::crc_fastest = implementations[usable() - 1].update;

std::span<const CrcImplementation> crc_implementations() noexcept { return {implementations, usable()}; }

int crc_extra_between(std::uint16_t before, std::uint16_t received) noexcept {
    const std::uint8_t index = inverse_high[received >> 8];
    const auto extra = static_cast<std::uint8_t>(index ^ before);
    return crc_update(before, extra) == received ? extra : -1;
}

}  // namespace mavloom::wire
