// The picture of a host, and how it is written.

#pragma once

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "host_scene.h"

// Rows of pixels as a PNG has them: each begins with a byte that says how it is filtered.
struct Picture {
    int width, height;
    size_t stride;
    std::vector<uint8_t> bytes;

    Picture(int width, int height)
        : width(width), height(height), stride(1 + 3 * static_cast<size_t>(width)),
          bytes(stride * height) {}

    // The first byte of a pixel.
    uint8_t* at(int column, int row) {
        return &bytes[stride * row + 1 + 3 * static_cast<size_t>(column)];
    }
};

inline void put(std::vector<uint8_t>& out, uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) out.push_back(value >> shift);
}

inline void chunk(FILE* file, const char* type, const std::vector<uint8_t>& data) {
    std::vector<uint8_t> length, sum;
    put(length, data.size());
    uLong crc = crc32(0, reinterpret_cast<const Bytef*>(type), 4);
    if (!data.empty()) crc = crc32(crc, data.data(), data.size());
    put(sum, crc);
    std::fwrite(length.data(), 1, 4, file);
    std::fwrite(type, 1, 4, file);
    std::fwrite(data.data(), 1, data.size(), file);
    std::fwrite(sum.data(), 1, 4, file);
}

// A PNG without compression, which is the fastest to write.
inline void write(const Picture& picture, const char* path) {
    FILE* file = std::fopen(path, "wb");
    if (!file) fail(std::string(path) + ": cannot be written");
    std::vector<uint8_t> header;
    put(header, picture.width);
    put(header, picture.height);
    for (const int value : {8, 2, 0, 0, 0}) header.push_back(value);

    constexpr size_t BLOCK = 65535;
    const std::vector<uint8_t>& bytes = picture.bytes;
    std::vector<uint8_t> data{0x78, 0x01};
    data.reserve(bytes.size() + bytes.size() / 1000 + 64);
    for (size_t i = 0; i < bytes.size(); i += BLOCK) {
        const size_t size = std::min(BLOCK, bytes.size() - i);
        data.push_back(i + size == bytes.size());
        for (const size_t value : {size, size >> 8, ~size, ~size >> 8}) data.push_back(value);
        data.insert(data.end(), bytes.begin() + i, bytes.begin() + i + size);
    }
    put(data, adler32(adler32(0, nullptr, 0), bytes.data(), bytes.size()));

    std::fwrite("\x89PNG\r\n\x1a\n", 1, 8, file);
    chunk(file, "IHDR", header);
    chunk(file, "IDAT", data);
    chunk(file, "IEND", {});
    if (std::fclose(file) != 0) fail(std::string(path) + ": cannot be written");
}
