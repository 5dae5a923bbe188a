// What our programs around Embree share: rays of a packet, and threads that take tiles.

#pragma once

#include <pmmintrin.h>

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

#include "embree_geometry.h"

constexpr int TILE = 32;
constexpr int LANES = 16;

// Set what a ray of a packet is before it has met anything, but where it starts and goes.
inline void clear_ray(RTCRayHit16& packet, int i) {
    packet.ray.tnear[i] = 0;
    packet.ray.tfar[i] = BEYOND;
    packet.ray.time[i] = 0;
    packet.ray.mask[i] = 0xFFFFFFFF;
    packet.ray.flags[i] = 0;
    packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    packet.hit.primID[i] = RTC_INVALID_GEOMETRY_ID;
    packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
}

// Call a function for each tile of a picture, with its first column and row, and those after it.
template <typename Function>
void for_each_tile(int width, int height, int threads, const Function& trace_tile) {
    const int across = (width + TILE - 1) / TILE;
    const int tiles = across * ((height + TILE - 1) / TILE);
    std::atomic<int> next{0};
    const auto work = [&] {
        _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);  // as Embree's manual demands of each thread
        _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
        for (int i = next++; i < tiles; i = next++) {
            const int left = i % across * TILE, top = i / across * TILE;
            trace_tile(left, top, std::min(left + TILE, width), std::min(top + TILE, height));
        }
    };
    std::vector<std::thread> workers;
    for (int i = 1; i < threads; i++) workers.emplace_back(work);
    work();
    for (std::thread& worker : workers) worker.join();
}
