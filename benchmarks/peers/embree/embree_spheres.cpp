// Renders spheres and planes with Embree: the host of a peer beside which vtray is measured.
//
//     embree_spheres [-t THREADS] [--single] [--own] SCENE OUTPUT
//
// SCENE is a file as host_scene.py describes it; OUTPUT is a PNG. Rays go in packets of 16, or
// single; spheres are geometry of ours, or Embree's own. What took how long goes to standard output.
// Planes are intersected here, without Embree; they block no light.
//
// Camera space: the eye at the origin, x to the right, y up, z forward.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "embree_work.h"
#include "host_picture.h"
#include "host_scene.h"

namespace {

constexpr int SIDE = 4;  // a packet is 4 x 4 pixels
static_assert(LANES == SIDE * SIDE);
constexpr float NEAR = 1e-4F;  // where a shadow ray starts: rounding, with room to spare

struct Scene : HostScene {
    RTCScene embree;
};

struct Options {
    int threads = 1;
    bool single = false;
    bool own = false;
    const char* scene = nullptr;
    const char* output = nullptr;
};

// The shading of up to 16 rays: where they hit, and what.
struct alignas(64) Hits {
    float x[LANES], y[LANES], z[LANES];
    float normal_x[LANES], normal_y[LANES], normal_z[LANES];
    float r[LANES], g[LANES], b[LANES];
    int plane[LANES];  // which plane was hit; -1 is a sphere, -2 nothing
    float sum[LANES];  // of cosine times intensity over all lights
};

double now() {
    using namespace std::chrono;
    return duration<double>(steady_clock::now().time_since_epoch()).count();
}

// ------------------------------------------------------------------------------------------- hits

// What a ray met: the nearest sphere as Embree found it, or a plane that is nearer.
void settle(
    const Scene& scene, const float* direction, float t, unsigned sphere, Hits& hits, int i) {
    const float dx = direction[0], dy = direction[1], dz = direction[2];
    int nearest = sphere == RTC_INVALID_GEOMETRY_ID ? -2 : -1;
    for (int j = 0; j < scene.header->planes; j++) {
        const Plane& plane = scene.planes[j];
        const float at = plane.offset / (plane.x * dx + plane.y * dy + plane.z * dz);
        if (at > 0 && at < t) {
            t = at;
            nearest = j;
        }
    }
    hits.plane[i] = nearest;
    hits.sum[i] = 0;
    hits.x[i] = nearest == -2 ? 0 : t * dx;
    hits.y[i] = nearest == -2 ? 0 : t * dy;
    hits.z[i] = nearest == -2 ? 0 : t * dz;
    if (nearest >= 0) {
        const Plane& plane = scene.planes[nearest];
        hits.normal_x[i] = plane.x;
        hits.normal_y[i] = plane.y;
        hits.normal_z[i] = plane.z;
        hits.r[i] = plane.r;
        hits.g[i] = plane.g;
        hits.b[i] = plane.b;
    } else if (nearest == -1) {
        const Sphere& ball = scene.spheres[sphere];
        const float nx = hits.x[i] - ball.x, ny = hits.y[i] - ball.y, nz = hits.z[i] - ball.z;
        // The side that the ray came from: the other one when it is seen from inside.
        const float facing = nx * dx + ny * dy + nz * dz > 0 ? -1.0F : 1.0F;
        const float unit = facing / std::sqrt(nx * nx + ny * ny + nz * nz);
        hits.normal_x[i] = nx * unit;
        hits.normal_y[i] = ny * unit;
        hits.normal_z[i] = nz * unit;
        const float scale = scene.header->lambert;
        const uint8_t* color = scene.colors + 3 * static_cast<size_t>(sphere);
        hits.r[i] = scale * color[0];
        hits.g[i] = scale * color[1];
        hits.b[i] = scale * color[2];
    }
}

// ------------------------------------------------------------------------------------ single rays

void trace_single(const Scene& scene, int column, int row, Hits& hits) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    const Header& header = *scene.header;
    const float across = (column - 0.5F * header.width) * header.pixel_width;
    const float above = (0.5F * header.height - row) * header.pixel_height;
    const float unit = 1.0F / std::sqrt(across * across + above * above + 1.0F);
    const float direction[3] = {across * unit, above * unit, unit};

    RTCRayHit ray{};
    ray.ray.dir_x = direction[0];
    ray.ray.dir_y = direction[1];
    ray.ray.dir_z = direction[2];
    ray.ray.tfar = BEYOND;
    ray.ray.mask = 0xFFFFFFFF;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene.embree, &context, &ray);
    const unsigned found =
        ray.hit.geomID == RTC_INVALID_GEOMETRY_ID ? RTC_INVALID_GEOMETRY_ID : ray.hit.primID;
    settle(scene, direction, ray.ray.tfar, found, hits, 0);
    if (hits.plane[0] == -2) return;

    for (int k = 0; k < header.lights; k++) {
        const Light& light = scene.lights[k];
        const float dx = light.x - hits.x[0], dy = light.y - hits.y[0], dz = light.z - hits.z[0];
        const float squared = dx * dx + dy * dy + dz * dz;
        const float shrink = 1.0F / std::sqrt(squared);
        const float d[3] = {dx * shrink, dy * shrink, dz * shrink};
        const float cosine =
            hits.normal_x[0] * d[0] + hits.normal_y[0] * d[1] + hits.normal_z[0] * d[2];
        const float far = squared * shrink;
        if (cosine <= 0) continue;
        RTCRay shadow{};
        shadow.org_x = hits.x[0];
        shadow.org_y = hits.y[0];
        shadow.org_z = hits.z[0];
        shadow.tnear = NEAR;
        shadow.dir_x = d[0];
        shadow.dir_y = d[1];
        shadow.dir_z = d[2];
        shadow.tfar = far;
        shadow.mask = 0xFFFFFFFF;
        rtcOccluded1(scene.embree, &context, &shadow);
        if (shadow.tfar >= 0) hits.sum[0] += cosine * light.intensity;
    }
}

// ---------------------------------------------------------------------------------- packets of 16

void trace_packet(const Scene& scene, int left, int top, Hits& hits) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    const Header& header = *scene.header;
    alignas(64) RTCRayHit16 packet;
    alignas(64) int valid[LANES];
    const float middle_x = 0.5F * header.width, middle_y = 0.5F * header.height;
#pragma omp simd
    for (int i = 0; i < LANES; i++) {
        const int column = left + i % SIDE, row = top + i / SIDE;
        const float across = (column - middle_x) * header.pixel_width;
        const float above = (middle_y - row) * header.pixel_height;
        const float unit = 1.0F / std::sqrt(across * across + above * above + 1.0F);
        valid[i] = column < header.width && row < header.height ? -1 : 0;
        packet.ray.org_x[i] = packet.ray.org_y[i] = packet.ray.org_z[i] = 0;
        packet.ray.dir_x[i] = across * unit;
        packet.ray.dir_y[i] = above * unit;
        packet.ray.dir_z[i] = unit;
        clear_ray(packet, i);
    }
    rtcIntersect16(valid, scene.embree, &context, &packet);
    bool any = false;
    for (int i = 0; i < LANES; i++) {
        const float direction[3] = {packet.ray.dir_x[i], packet.ray.dir_y[i], packet.ray.dir_z[i]};
        settle(scene, direction, packet.ray.tfar[i], packet.hit.primID[i], hits, i);
        any |= hits.plane[i] != -2;
    }
    if (!any) return;

    RTCRay16& shadow = packet.ray;
    alignas(64) float cosine[LANES];
    for (int k = 0; k < header.lights; k++) {
        const Light light = scene.lights[k];
        int lit = 0;
#pragma omp simd reduction(| : lit)
        for (int i = 0; i < LANES; i++) {
            const float dx = light.x - hits.x[i], dy = light.y - hits.y[i];
            const float dz = light.z - hits.z[i];
            const float squared = dx * dx + dy * dy + dz * dz;
            const float shrink = 1.0F / std::sqrt(squared);
            shadow.org_x[i] = hits.x[i];
            shadow.org_y[i] = hits.y[i];
            shadow.org_z[i] = hits.z[i];
            shadow.tnear[i] = NEAR;
            shadow.dir_x[i] = dx * shrink;
            shadow.dir_y[i] = dy * shrink;
            shadow.dir_z[i] = dz * shrink;
            shadow.tfar[i] = squared * shrink;
            cosine[i] = shrink * (hits.normal_x[i] * dx + hits.normal_y[i] * dy +
                                  hits.normal_z[i] * dz);
            valid[i] = hits.plane[i] != -2 && cosine[i] > 0 ? -1 : 0;
            lit |= valid[i];
        }
        if (!lit) continue;
        rtcOccluded16(valid, scene.embree, &context, &shadow);
#pragma omp simd
        for (int i = 0; i < LANES; i++) {
            const bool reached = valid[i] && shadow.tfar[i] >= 0;
            hits.sum[i] += reached ? cosine[i] * light.intensity : 0.0F;
        }
    }
}

void develop(const Hits& hits, int i, Picture& picture, int column, int row) {
    if (column >= picture.width || row >= picture.height || hits.plane[i] == -2) return;
    uint8_t* pixel = picture.at(column, row);
    pixel[0] = static_cast<uint8_t>(std::min(255.0F, hits.r[i] * hits.sum[i]));
    pixel[1] = static_cast<uint8_t>(std::min(255.0F, hits.g[i] * hits.sum[i]));
    pixel[2] = static_cast<uint8_t>(std::min(255.0F, hits.b[i] * hits.sum[i]));
}

void trace(const Scene& scene, const Options& options, Picture& picture) {
    const bool single = options.single;
    const auto trace_tile = [&](int left, int top, int right, int bottom) {
        Hits hits{};
        const int side = single ? 1 : SIDE;
        for (int row = top; row < bottom; row += side) {
            for (int column = left; column < right; column += side) {
                if (single) {
                    trace_single(scene, column, row, hits);
                    develop(hits, 0, picture, column, row);
                    continue;
                }
                trace_packet(scene, column, row, hits);
                for (int i = 0; i < LANES; i++)
                    develop(hits, i, picture, column + i % SIDE, row + i / SIDE);
            }
        }
    };
    for_each_tile(picture.width, picture.height, options.threads, trace_tile);
}

Options parse(int count, char** arguments) {
    Options options;
    for (int i = 1; i < count; i++) {
        const std::string word = arguments[i];
        const bool more = i + 1 < count;
        if (word == "-t" && more) {
            options.threads = std::max(1, std::atoi(arguments[++i]));
        } else if (word == "--single") {
            options.single = true;
        } else if (word == "--own") {
            options.own = true;
        } else if (!options.scene) {
            options.scene = arguments[i];
        } else {
            options.output = arguments[i];
        }
    }
    return options;
}

}  // namespace

int main(int count, char** arguments) {
    if (count == 2 && std::strcmp(arguments[1], "--version") == 0) {
        std::printf("Embree %s\n", RTC_VERSION_STRING);
        return 0;
    }
    const Options options = parse(count, arguments);
    if (!options.output) fail("usage: embree_spheres [options] SCENE OUTPUT");

    const double start = now();
    Scene scene{load(options.scene), nullptr};
    const double loaded = now();
    const std::string threads = "threads=" + std::to_string(options.threads);
    const RTCDevice device = rtcNewDevice(threads.c_str());
    const bool quick = !options.own && scene.header->spheres >= MANY;
    scene.embree = build(scene, device, options.own, quick);
    if (rtcGetDeviceError(device) != RTC_ERROR_NONE) fail("Embree cannot build this scene");
    const double built = now();
    Picture picture(scene.header->width, scene.header->height);
    trace(scene, options, picture);
    const double traced = now();
    write(picture, options.output);
    const double written = now();

    std::printf("load  %8.4f s\n", loaded - start);
    std::printf("build %8.4f s\n", built - loaded);
    std::printf("trace %8.4f s\n", traced - built);
    std::printf("write %8.4f s\n", written - traced);
    std::fflush(stdout);
    _exit(0);  // the system frees all memory sooner than Embree would
}
