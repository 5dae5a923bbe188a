// The scene file of the hosts, which host_scene.py describes.

#pragma once

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

struct Header {
    char magic[4];
    int32_t width, height, planes, lights, spheres;
    float pixel_width, pixel_height, lambert;
    int32_t unused[3];
};

struct Plane {
    float x, y, z, offset;  // the unit normal, and its product with a point of the plane
    float r, g, b, unused;
};

struct Light {
    float x, y, z, intensity;
};

struct Sphere {
    float x, y, z, radius;
};

struct HostScene {
    const Header* header;
    const Plane* planes;
    const Light* lights;
    const Sphere* spheres;
    const uint8_t* colors;
};

[[noreturn]] inline void fail(const std::string& message) {
    std::fprintf(stderr, "Error: %s\n", message.c_str());
    std::exit(1);
}

// The file is mapped, not copied; it stays so until the process ends.
inline HostScene load(const char* path) {
    const int file = open(path, O_RDONLY);
    struct stat info{};
    if (file < 0 || fstat(file, &info) != 0) fail(std::string(path) + ": cannot be read");
    void* data = mmap(nullptr, info.st_size, PROT_READ, MAP_PRIVATE | MAP_POPULATE, file, 0);
    close(file);
    if (data == MAP_FAILED) fail(std::string(path) + ": cannot be mapped");

    HostScene scene{};
    scene.header = static_cast<const Header*>(data);
    if (std::memcmp(scene.header->magic, "VTS1", 4) != 0) fail(std::string(path) + ": not a scene");
    scene.planes = reinterpret_cast<const Plane*>(scene.header + 1);
    scene.lights = reinterpret_cast<const Light*>(scene.planes + scene.header->planes);
    scene.spheres = reinterpret_cast<const Sphere*>(scene.lights + scene.header->lights);
    scene.colors = reinterpret_cast<const uint8_t*>(scene.spheres + scene.header->spheres);
    return scene;
}
