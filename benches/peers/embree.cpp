// Embree's side of the comparison: stays alive, does what its input says, a line each, and answers with a line of
// JSON.
//
//   g++ -O3 -march=native -std=c++17 embree.cpp -o embree -lembree3 -lpthread
//   embree DIR      DIR: what bench-worker's `export DIR` wrote, the knot and its rays
//
//   build                                         builds the tree, medium quality, one thread: seconds, bytes with mesh
//   rays KIND WIDTH coherent|incoherent THREADS   traces DIR/KIND.rays: seconds, rays, hits, mean_t
//
// WIDTH 1, 8 or 16 rays are given to Embree at a time. The time of `rays` is what it takes from columns of rays in
// memory to columns of hits, as on Snell's side; threads take chunks of 1024 rays. Embree 3 (Debian's libembree-dev).
#include <embree3/rtcore.h>
#include <immintrin.h>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

using std::string;
using std::vector;

static double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// ---- what bench-worker exports ----------------------------------------------------------------------------------

static std::ifstream open_file(const string& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw std::runtime_error("cannot read " + path);
    return file;
}

template <class T>
static vector<T> read(std::ifstream& file, size_t count) {
    vector<T> values(count);
    file.read(reinterpret_cast<char*>(values.data()), count * sizeof(T));
    if (!file) throw std::runtime_error("a file ends early");
    return values;
}

struct Mesh {
    vector<float> vertices;
    vector<uint32_t> faces;
};

static Mesh read_mesh(const string& path) {
    auto file = open_file(path);
    const auto counts = read<uint32_t>(file, 2);
    Mesh mesh;
    mesh.vertices = read<float>(file, 3 * size_t(counts[0]));
    mesh.faces = read<uint32_t>(file, 3 * size_t(counts[1]));
    return mesh;
}

struct Rays {
    vector<float> in[7];  // origin, direction, t_max
    vector<float> t;
    vector<uint32_t> hit;  // geometry id; for shadow rays 0 where something is hit
    size_t size() const { return t.size(); }
};

static Rays read_rays(const string& path) {
    auto file = open_file(path);
    const size_t count = read<uint32_t>(file, 1)[0];
    Rays rays;
    for (auto& column : rays.in) column = read<float>(file, count);
    rays.t.assign(count, 0);
    rays.hit.assign(count, 0);
    return rays;
}

// ---- building ---------------------------------------------------------------------------------------------------

static std::atomic<int64_t> bytes_held{0};

static bool count_bytes(void*, ssize_t bytes, bool) {
    bytes_held += bytes;
    return true;
}

// Builds on one thread. Embree's limit is one for the process, the smallest of all devices; it does not hold for
// tracing, whose threads are ours.
static RTCDevice new_device() {
    RTCDevice device = rtcNewDevice("threads=1");
    if (!device) throw std::runtime_error("Embree does not start");
    return device;
}

template <class T>
static void fill(RTCGeometry geometry, RTCBufferType type, RTCFormat format, const vector<T>& values) {
    void* to = rtcSetNewGeometryBuffer(geometry, type, 0, format, 3 * sizeof(T), values.size() / 3);
    memcpy(to, values.data(), values.size() * sizeof(T));
}

static RTCScene build(RTCDevice device, const Mesh& mesh, double& seconds) {
    RTCScene scene = rtcNewScene(device);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    fill(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, mesh.vertices);
    fill(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, mesh.faces);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    const double start = now();
    rtcCommitScene(scene);
    seconds = now() - start;
    return scene;
}

// ---- tracing ----------------------------------------------------------------------------------------------------

struct Job {
    RTCScene scene;
    Rays& rays;
    bool any_hit;  // or the closest
    bool coherent;
    int width;
};

static const size_t CHUNK = 1024;
alignas(64) static const int VALID[16] = {-1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1};

static void occluded(RTCScene s, RTCIntersectContext* c, RTCRayHit8* r) { rtcOccluded8(VALID, s, c, &r->ray); }
static void occluded(RTCScene s, RTCIntersectContext* c, RTCRayHit16* r) { rtcOccluded16(VALID, s, c, &r->ray); }
static void intersect(RTCScene s, RTCIntersectContext* c, RTCRayHit8* r) { rtcIntersect8(VALID, s, c, r); }
static void intersect(RTCScene s, RTCIntersectContext* c, RTCRayHit16* r) { rtcIntersect16(VALID, s, c, r); }

template <class RayHit, int N>
static void trace_packets(const Job& job, RTCIntersectContext* context, size_t begin, size_t end) {
    Rays& rays = job.rays;
    for (size_t i = begin; i < end; i += N) {
        alignas(64) RayHit packet;
        auto& ray = packet.ray;
        float* const to[7] = {ray.org_x, ray.org_y, ray.org_z, ray.dir_x, ray.dir_y, ray.dir_z, ray.tfar};
        for (int c = 0; c < 7; c++) memcpy(to[c], &rays.in[c][i], N * sizeof(float));
        for (int k = 0; k < N; k++) {
            ray.tnear[k] = ray.time[k] = 0;
            ray.mask[k] = ~0u;
            ray.id[k] = ray.flags[k] = 0;
            packet.hit.geomID[k] = packet.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
        }
        if (job.any_hit) {
            occluded(job.scene, context, &packet);
            for (int k = 0; k < N; k++) rays.hit[i + k] = ray.tfar[k] < 0 ? 0 : RTC_INVALID_GEOMETRY_ID;
        } else {
            intersect(job.scene, context, &packet);
            memcpy(&rays.t[i], ray.tfar, N * sizeof(float));
            memcpy(&rays.hit[i], packet.hit.geomID, N * sizeof(uint32_t));
        }
    }
}

static void trace_singly(const Job& job, RTCIntersectContext* context, size_t begin, size_t end) {
    Rays& rays = job.rays;
    for (size_t i = begin; i < end; i++) {
        alignas(16) RTCRayHit single;
        auto& ray = single.ray;
        float* const to[7] = {&ray.org_x, &ray.org_y, &ray.org_z, &ray.dir_x, &ray.dir_y, &ray.dir_z, &ray.tfar};
        for (int c = 0; c < 7; c++) *to[c] = rays.in[c][i];
        ray.tnear = ray.time = 0;
        ray.mask = ~0u;
        ray.id = ray.flags = 0;
        single.hit.geomID = single.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        if (job.any_hit) {
            rtcOccluded1(job.scene, context, &ray);
            rays.hit[i] = ray.tfar < 0 ? 0 : RTC_INVALID_GEOMETRY_ID;
        } else {
            rtcIntersect1(job.scene, context, &single);
            rays.t[i] = ray.tfar;
            rays.hit[i] = single.hit.geomID;
        }
    }
}

static double trace(const Job& job, int threads) {
    std::atomic<size_t> next{0};
    auto work = [&] {
        // As Embree's manual asks for, chapter "Performance Recommendations".
        _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
        _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        context.flags = job.coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
        for (size_t begin; (begin = next.fetch_add(CHUNK)) < job.rays.size();) {
            const size_t end = std::min(begin + CHUNK, job.rays.size());
            if (job.width == 1) trace_singly(job, &context, begin, end);
            if (job.width == 8) trace_packets<RTCRayHit8, 8>(job, &context, begin, end);
            if (job.width == 16) trace_packets<RTCRayHit16, 16>(job, &context, begin, end);
        }
    };
    const double start = now();
    vector<std::thread> others;
    for (int i = 1; i < threads; i++) others.emplace_back(work);
    work();
    for (auto& thread : others) thread.join();
    return now() - start;
}

// ---- answering --------------------------------------------------------------------------------------------------

struct Worker {
    string folder;
    Mesh mesh;
    RTCDevice device;
    RTCScene scene;
    std::map<string, Rays> sets;

    explicit Worker(const string& from) : folder(from), mesh(read_mesh(from + "/knot.mesh")), device(new_device()) {
        double seconds;
        scene = build(device, mesh, seconds);
    }

    void build_again() {
        RTCDevice own = new_device();
        bytes_held = 0;
        rtcSetDeviceMemoryMonitorFunction(own, count_bytes, nullptr);
        double seconds;
        RTCScene built = build(own, mesh, seconds);
        printf("{\"seconds\": %.9f, \"bytes\": %lld}\n", seconds, static_cast<long long>(bytes_held));
        rtcReleaseScene(built);
        rtcReleaseDevice(own);
    }

    void rays(const string& kind, int width, bool coherent, int threads) {
        auto found = sets.find(kind);
        if (found == sets.end()) found = sets.emplace(kind, read_rays(folder + "/" + kind + ".rays")).first;
        Rays& set = found->second;
        const bool shadow = kind == "shadow";
        const double seconds = trace({scene, set, shadow, coherent, width}, threads);
        size_t hits = 0;
        double sum = 0;
        for (size_t i = 0; i < set.size(); i++) {
            if (set.hit[i] == RTC_INVALID_GEOMETRY_ID) continue;
            hits++;
            sum += shadow ? 0 : set.t[i];
        }
        printf("{\"seconds\": %.9f, \"rays\": %zu, \"hits\": %zu, \"mean_t\": %.9f}\n", seconds, set.size(), hits,
               hits ? sum / hits : 0.0);
    }

    void answer(const string& line) {
        std::istringstream words(line);
        string what, kind, coherence;
        int width = 0, threads = 0;
        words >> what;
        if (what == "build") return build_again();
        const bool complete = what == "rays" && words >> kind >> width >> coherence >> threads;
        const bool possible = threads > 0 && (width == 1 || width == 8 || width == 16);
        if (!complete || !possible) throw std::runtime_error("not understood: " + line);
        rays(kind, width, coherence == "coherent", threads);
    }
};

int main(int count, char** arguments) try {
    if (count != 2) throw std::runtime_error("usage: embree DIR");
    Worker worker(arguments[1]);
    for (string line; std::getline(std::cin, line);) {
        worker.answer(line);
        fflush(stdout);
    }
    return 0;
} catch (const std::exception& error) {
    fprintf(stderr, "embree: %s\n", error.what());
    return 1;
}
