// What the engines have in common: the scene, and the file of a run. Both are described in
// crates/sbbk-lab/src/study/hard/engines.rs.
#pragma once

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

// `VmRSS:` or `VmHWM:` of this process, in MiB.
inline float memory(const std::string &name) {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;)
        if (float kilobytes; word == name && status >> kilobytes) return kilobytes / 1024;
    return 0;
}

// The scene.
class Scene {
public:
    explicit Scene(const char *path) {
        std::ifstream file(path, std::ios::binary);
        for (float number; file.read(reinterpret_cast<char *>(&number), sizeof number);)
            numbers.push_back(number);
        time_step = take(), gravity = take(), friction = take();
        floor = take<3>();
        steps = int(take());
        mass = take();
        inertia = take<3>();
        vertices.resize(count());
        for (auto &vertex : vertices) vertex = take<3>();
        triangles.resize(count());
        for (auto &triangle : triangles)
            for (int &index : triangle) index = int(take());
        poses.resize(count());
        for (auto &pose : poses) pose = take<7>();
    }

    float time_step, gravity, friction, mass;
    // Half extents; the top is at height 0.
    std::array<float, 3> floor;
    std::array<float, 3> inertia;
    int steps;
    std::vector<std::array<float, 3>> vertices;
    std::vector<std::array<int, 3>> triangles;
    // Place and orientation (x, y, z, w).
    std::vector<std::array<float, 7>> poses;

private:
    std::vector<float> numbers;
    size_t next = 0;

    float take() { return numbers.at(next++); }
    size_t count() { return size_t(take()); }
    template <size_t N> std::array<float, N> take() {
        std::array<float, N> taken;
        for (float &number : taken) number = take();
        return taken;
    }
};

// The file of a run. It is made when the world is empty.
class Run {
public:
    explicit Run(const char *path) : file(std::fopen(path, "wb")), empty(memory("VmRSS:")) {
        if (!file) std::exit(1);
    }
    ~Run() { std::fclose(file); }

    // Steps once: `step` is timed and returns the number of contact points.
    template <typename Step> void step(Step step) {
        const auto start = std::chrono::steady_clock::now();
        const float points = float(step());
        const std::chrono::duration<float, std::milli> time = std::chrono::steady_clock::now() - start;
        const float peak = memory("VmHWM:");
        write(std::array<float, 4>{time.count(), points, peak, peak - empty});
    }

    // After a step, of each head: place, orientation (x, y, z, w), velocity, angular velocity.
    void head(const std::array<float, 13> &state) { write(state); }

private:
    std::FILE *file;
    float empty;

    template <size_t N> void write(const std::array<float, N> &numbers) {
        if (std::fwrite(numbers.data(), sizeof(float), N, file) != N) std::exit(1);
    }
};
