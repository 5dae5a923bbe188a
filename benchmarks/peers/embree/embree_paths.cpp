// Renders spheres over a floor under a sky of radiance 1 with Embree, by paths.
//
//     embree_paths [--single] THREADS SCENE OUTPUT SAMPLES PICTURES SURFACES
//
// SCENE is a file as host_scene.py describes it, seen in parallel rays along z, of pixels as large
// as it says; its first plane is the floor. OUTPUT is a .npy file for the light of so many pictures
// with other random numbers, by paths over so many surfaces. The samples of a pixel, whose number is
// a multiple of 16, go in packets of 16, or single. What the last picture took goes to standard
// output, after building.

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
#include "host_scene.h"

namespace {

constexpr float OFF = 1e-2F;  // how far off its surface a ray starts, in radii: rounding, with room
constexpr float PI = 3.14159265F;

struct Scene : HostScene {
    RTCScene embree;
};

struct Options {
    bool single = false;
    int threads = 1, samples = 16, pictures = 1, surfaces = 1;
    const char* scene = nullptr;
    const char* output = nullptr;
};

// Random numbers from a counter: PCG, by M. E. O'Neill, with its output permutation RXS-M-XS.
struct Random {
    uint32_t state;

    float next() {
        state = state * 747796405U + 2891336453U;
        uint32_t word = ((state >> ((state >> 28) + 4U)) ^ state) * 277803737U;
        word ^= word >> 22;
        return (word >> 8) * 0x1p-24F;
    }
};

Random random_of(int seed, int column, int row, int sample) {
    Random made{(static_cast<uint32_t>(seed) * 4096U + row) * 4096U + column};
    made.state = made.state * 9781U + sample * 6271U;
    made.next();
    return made;
}

struct Ray {
    float x, y, z, dx, dy, dz;
};

Ray camera_ray(const Scene& scene, int column, int row, Random& random) {
    const Header& header = *scene.header;
    const float across = column - 0.5F * header.width + random.next() - 0.5F;
    const float above = 0.5F * header.height - row - random.next() + 0.5F;
    return {across * header.pixel_width, above * header.pixel_height, 0, 0, 0, 1};
}

// Turn a ray that met a sphere, or the floor if that is nearer, into one that is scattered there, or
// tell that it met nothing.
bool scatter(const Scene& scene, float t, unsigned sphere, Ray& ray, Random& random) {
    const Plane& floor = scene.planes[0];
    const float facing = floor.x * ray.dx + floor.y * ray.dy + floor.z * ray.dz;
    const float height = floor.x * ray.x + floor.y * ray.y + floor.z * ray.z - floor.offset;
    const float at = -height / facing;
    const bool is_floor = at > 0 && at < t;
    if (!is_floor && sphere == RTC_INVALID_GEOMETRY_ID) return false;
    t = is_floor ? at : t;
    const float x = ray.x + t * ray.dx, y = ray.y + t * ray.dy, z = ray.z + t * ray.dz;
    const Sphere& ball = scene.spheres[is_floor ? 0 : sphere];
    float nx = is_floor ? floor.x : x - ball.x, ny = is_floor ? floor.y : y - ball.y;
    float nz = is_floor ? floor.z : z - ball.z;
    // The side that the ray came from: the other one when a sphere is seen from inside.
    const float along = nx * ray.dx + ny * ray.dy + nz * ray.dz;
    const float unit = (along > 0 ? -1.0F : 1.0F) / std::sqrt(nx * nx + ny * ny + nz * nz);
    nx *= unit, ny *= unit, nz *= unit;
    // A point of the unit ball's surface beside the normal: directions by the cosine.
    const float up = 1 - 2 * random.next(), turn = 2 * PI * random.next();
    const float level = std::sqrt(std::max(0.0F, 1 - up * up));
    float dx = nx + level * std::cos(turn), dy = ny + level * std::sin(turn), dz = nz + up;
    const float shrink = 1 / std::sqrt(dx * dx + dy * dy + dz * dz + 1e-20F);
    ray = {x + OFF * nx, y + OFF * ny, z + OFF * nz, dx * shrink, dy * shrink, dz * shrink};
    return true;
}

float light_single(const Scene& scene, const Options& options, int seed, int column, int row) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    float sum = 0;
    for (int sample = 0; sample < options.samples; sample++) {
        Random random = random_of(seed, column, row, sample);
        Ray ray = camera_ray(scene, column, row, random);
        float share = 1;
        for (int surface = 0; surface <= options.surfaces; surface++) {
            RTCRayHit found{};
            found.ray.org_x = ray.x, found.ray.org_y = ray.y, found.ray.org_z = ray.z;
            found.ray.dir_x = ray.dx, found.ray.dir_y = ray.dy, found.ray.dir_z = ray.dz;
            found.ray.tfar = BEYOND;
            found.ray.mask = 0xFFFFFFFF;
            found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
            found.hit.primID = RTC_INVALID_GEOMETRY_ID;
            rtcIntersect1(scene.embree, &context, &found);
            if (!scatter(scene, found.ray.tfar, found.hit.primID, ray, random)) {
                sum += surface > 0 ? share : 0;
                break;
            }
            share *= scene.header->lambert;
        }
    }
    return sum / options.samples;
}

float light_packets(const Scene& scene, const Options& options, int seed, int column, int row) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    float sum = 0;
    for (int first = 0; first < options.samples; first += LANES) {
        alignas(64) RTCRayHit16 packet;
        alignas(64) int valid[LANES];
        Ray ray[LANES];
        Random random[LANES];
        for (int i = 0; i < LANES; i++) {
            random[i] = random_of(seed, column, row, first + i);
            ray[i] = camera_ray(scene, column, row, random[i]);
            valid[i] = -1;
        }
        float share = 1;
        for (int surface = 0; surface <= options.surfaces; surface++) {
            context.flags = surface ? RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT
                                    : RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
            for (int i = 0; i < LANES; i++) {
                packet.ray.org_x[i] = ray[i].x;
                packet.ray.org_y[i] = ray[i].y;
                packet.ray.org_z[i] = ray[i].z;
                packet.ray.dir_x[i] = ray[i].dx;
                packet.ray.dir_y[i] = ray[i].dy;
                packet.ray.dir_z[i] = ray[i].dz;
                clear_ray(packet, i);
            }
            rtcIntersect16(valid, scene.embree, &context, &packet);
            bool any = false;
            for (int i = 0; i < LANES; i++) {
                if (!valid[i]) continue;
                if (scatter(scene, packet.ray.tfar[i], packet.hit.primID[i], ray[i], random[i])) {
                    any = true;
                    continue;
                }
                sum += surface > 0 ? share : 0;
                valid[i] = 0;
            }
            if (!any) break;
            share *= scene.header->lambert;
        }
    }
    return sum / options.samples;
}

void trace(const Scene& scene, const Options& options, int seed, float* picture) {
    const int width = scene.header->width, height = scene.header->height;
    const auto light_of = options.single ? light_single : light_packets;
    for_each_tile(width, height, options.threads, [&](int left, int top, int right, int bottom) {
        for (int row = top; row < bottom; row++) {
            for (int column = left; column < right; column++) {
                const float light = light_of(scene, options, seed, column, row);
                std::fill_n(picture + 3 * (static_cast<size_t>(row) * width + column), 3, light);
            }
        }
    });
}

void write(const Header& header, const std::vector<float>& light, const Options& options) {
    std::string shape = "{'descr': '<f4', 'fortran_order': False, 'shape': (" +
                        std::to_string(options.pictures) + ", " + std::to_string(header.height) +
                        ", " + std::to_string(header.width) + ", 3), }";
    shape.resize(117, ' ');
    shape += '\n';
    FILE* file = std::fopen(options.output, "wb");
    if (!file) fail(std::string(options.output) + ": cannot be written");
    std::fwrite("\x93NUMPY\x01\x00\x76\x00", 1, 10, file);
    std::fwrite(shape.data(), 1, shape.size(), file);
    std::fwrite(light.data(), sizeof(float), light.size(), file);
    if (std::fclose(file) != 0) fail(std::string(options.output) + ": cannot be written");
}

Options parse(int count, char** arguments) {
    Options options;
    options.single = count > 1 && std::strcmp(arguments[1], "--single") == 0;
    char** rest = arguments + 1 + options.single;
    if (arguments + count - rest != 6)
        fail("usage: embree_paths [--single] THREADS SCENE OUTPUT SAMPLES PICTURES SURFACES");
    options.threads = std::max(1, std::atoi(rest[0]));
    options.scene = rest[1];
    options.output = rest[2];
    options.samples = std::atoi(rest[3]);
    options.pictures = std::atoi(rest[4]);
    options.surfaces = std::atoi(rest[5]);
    return options;
}

}  // namespace

int main(int count, char** arguments) {
    const Options options = parse(count, arguments);
    Scene scene{load(options.scene), nullptr};
    const std::string threads = "threads=" + std::to_string(options.threads);
    const RTCDevice device = rtcNewDevice(threads.c_str());
    scene.embree = build(scene, device, false, false);
    if (rtcGetDeviceError(device) != RTC_ERROR_NONE) fail("Embree cannot build this scene");

    const size_t size = 3 * static_cast<size_t>(scene.header->width) * scene.header->height;
    std::vector<float> light(size * options.pictures);
    double seconds = 0;
    for (int seed = 0; seed < options.pictures; seed++) {
        using namespace std::chrono;
        const auto start = steady_clock::now();
        trace(scene, options, seed, light.data() + size * seed);
        seconds = duration<double>(steady_clock::now() - start).count();
    }
    write(*scene.header, light, options);
    std::printf("trace %8.4f s\n", seconds);
    std::fflush(stdout);
    _exit(0);  // the system frees all memory sooner than Embree would
}
