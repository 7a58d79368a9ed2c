// radiosity/shooting.h  5  progressive refinement: the brightest unshot element shoots first
//
// Radiosity (Goral et al. 1984) by shooting (Cohen, Chen, Wallace, Greenberg 1988): the element or
// face with the most unshot power shoots it to all vertices at once.  It draws no random numbers.
// Biased: by unshot power, which only makes it too dark; by the mesh, because vertices on a border
// receive light slightly inside of it; by the fixed pattern of shadow rays; and, if whole faces
// shoot, by parts that are replaced by their mean.
#pragma once
#include <numeric>
#include <utility>

#include "app/threads.h"
#include "radiosity/missing.h"
#include "radiosity/target.h"
#include "radiosity/transfer.h"

namespace penumbra {

class Shooting {
public:
    // Both must outlive it.
    Shooting(const Scene& scene, const Mesh& mesh, Shooter shooter, unsigned threads)
        : scene_(scene),
          mesh_(mesh),
          shooter_(shooter),
          threads_(std::max(1u, threads)),
          tree_(mesh),
          map_(number_of_sides(mesh)),
          shot_(2 * mesh.elements()),
          sent_(2 * mesh.elements()),
          radiance_(tree_.first(mesh.faces.size())),
          best_(2 * mesh.faces.size()),
          order_(mesh.faces.size()),
          max_reflected_(greatest_albedo(scene, mesh)) {
        for (uint32_t side = 0; side < best_.size(); ++side) best_[side] = candidate(side);
        std::iota(order_.begin(), order_.end(), 0u);
        std::stable_sort(order_.begin(), order_.end(), [&](uint32_t a, uint32_t b) {
            return mesh.faces[a].vertices() > mesh.faces[b].vertices();
        });
        for (const Light& l : scene.lights)
            if (l.is_delta()) points_.push_back(&l);
        emitted_ = unsent();
        for (const Face& f : mesh.faces) area_ += 2 * double(f.area());
    }

    const IlluminationMap& map() const { return map_; }
    uint64_t shots() const { return shots_; }
    uint64_t rays() const { return rays_; }
    double seconds() const { return seconds_; }
    // Unshot power divided by emitted power.
    double unshot() const { return emitted_ > 0 ? unsent() / emitted_ : 0; }

    // An upper bound, see missing.h.  It is 1 while a point light has not shot.
    double error() const {
        if (next_point_ < points_.size()) return 1;
        Missing all;
        for (const Candidate& c : best_) all.add(c.missing);
        all.lose(lost_);
        return all.error(max_reflected_);
    }

    // Shoots until the target is met, nothing is left or `interrupted`; may be called again for a
    // stricter target.  The map is the same, bit for bit, for any number of threads: every vertex
    // receives one shot after the other.  But time, or a signal, may cut the last shot short:
    // vertices then lack part of its light.  Calls show(*this) between shots.
    template <class Show>
    void run(const ShootingTarget& target, Show show) {
        const auto start = std::chrono::steady_clock::now();
        const double before = seconds_;
        const std::chrono::duration<double> left(target.seconds > 0 ? target.seconds - before
                                                                    : lifetime);
        deadline_ = start + std::chrono::duration_cast<std::chrono::nanoseconds>(left);
        for (;;) {
            if (const Missing shot = std::exchange(flying_, {}); cut_short()) lost_.lose(shot);
            const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
            seconds_ = before + took.count();
            const bool enough = interrupted || met(target) || !choose();
            show(*this);
            if (enough) return;
            std::atomic<uint64_t> rays = 0;
            auto work = [&](size_t k, unsigned) { rays += receive(order_[k]); };
            by_workers(order_.size(), threads_, work, [](double) {});
            rays_ += rays;
        }
    }

    static Bytes bytes() {
        Bytes b;
        b.vertex += 2 * sizeof(rgb);
        b.element +=
            Trees::bytes_per_element + 2 * (sizeof(Corners) + sizeof(double)) + 2 * sizeof(Corners);
        b.face += 2 * sizeof(Candidate) + sizeof(uint32_t);
        return b;
    }

private:
    // For a side of a face, number 2 face + back: the unshot power, and the node that should shoot
    // next.
    struct Candidate {
        double all = 0, power = 0;  // means of the channels: of the side, of the node
        uint32_t node = 0;
        bool emits = false;  // light of its own, not yet sent
        Missing missing;
        auto rank() const { return std::pair(emits, power); }
    };

    const Scene& scene_;
    const Mesh& mesh_;
    const Shooter shooter_;
    const unsigned threads_;
    const Trees tree_;
    IlluminationMap map_;
    std::vector<Corners> shot_;      // exitance that element e has sent: number 2 e + back
    std::vector<double> sent_;       // the same, averaged over its corners and channels
    std::vector<Corners> radiance_;  // radiance of the nodes of the side that shoots
    std::vector<Candidate> best_;
    std::vector<uint32_t> order_;  // faces, the largest first, so that threads end together
    const rgb max_reflected_;      // greatest albedo of all faces
    std::vector<const Light*> points_;
    size_t next_point_ = 0;
    double emitted_ = 0, area_ = 0, seconds_ = 0;  // power; of both sides of all faces
    Missing flying_, lost_;  // upper bounds: of the current shot; of shots cut short
    std::chrono::steady_clock::time_point deadline_;
    static constexpr double lifetime = 1e9;  // seconds: no limit
    uint64_t shots_ = 0, rays_ = 0;

    // The shooter: a point light, or a node of a side.
    const Light* point_ = nullptr;
    uint32_t side_ = 0, node_ = 0;

    // ---- Shooters -------------------------------------------------------------------------------

    // The exitance (W / m^2) of an element, from all light received so far.  It never falls, not
    // even by rounding, so the unshot exitance is never negative.
    Corners exitance(const Face& f, uint32_t element, bool back) const {
        const auto& v = mesh_.corners[element];
        const rgb own = emission(scene_, f, back) * pi, rho = albedo(scene_, f);
        Corners M;
        for (size_t k = 0; k < 3; ++k) M[k] = own + rho * map_[2 * v[k] + back];
        return M;
    }

    Candidate candidate(uint32_t side) const {
        const uint32_t face = side / 2;
        const bool back = side % 2;
        const Face& f = mesh_.faces[face];
        const double area = double(f.area()) / f.elements();
        const bool lamp = max_of(emission(scene_, f, back)) > 0;
        Candidate best;
        for (uint32_t e = f.element; e < f.element + f.elements(); ++e) {
            const double sent = sent_[2 * size_t(e) + back];
            const Corners M = exitance(f, e, back);
            const double power = area * (double(mean_of(M.mean())) - sent);
            best.all += power;
            const auto& v = mesh_.corners[e];
            const Corners& shot = shot_[2 * size_t(e) + back];
            best.missing.add(area,
                             {map_[2 * v[0] + back], map_[2 * v[1] + back], map_[2 * v[2] + back]},
                             {M[0] - shot[0], M[1] - shot[1], M[2] - shot[2]});
            const auto rank = std::pair(lamp && sent == 0, power);
            if (power > 0 && rank > best.rank())
                best.power = power, best.node = tree_.leaf(e), best.emits = lamp && sent == 0;
        }
        if (shooter_ == Shooter::face) best.power = best.all, best.node = tree_.first(face);
        return best;
    }

    // Power of points that have not shot, and of all sides.
    double unsent() const {
        double power = 0;
        for (size_t k = next_point_; k < points_.size(); ++k) power += penumbra::power(*points_[k]);
        for (const Candidate& c : best_) power += c.all;
        return power;
    }

    bool met(const ShootingTarget& t) const {
        return (t.shots && shots_ >= t.shots) || (t.seconds > 0 && seconds_ >= t.seconds) ||
               unshot() <= t.unshot || (t.error > 0 && error() <= t.error);
    }

    // Lights first, then the side with the most unshot power.  False: there is none.
    bool choose() {
        point_ = next_point_ < points_.size() ? points_[next_point_++] : nullptr;
        if (point_) flying_.unsent.fill(double(INFINITY));
        if (!point_) {
            const auto best = std::max_element(
                best_.begin(), best_.end(), [](auto& a, auto& b) { return a.rank() < b.rank(); });
            if (best == best_.end() || !(best->power > 0)) return false;
            side_ = uint32_t(best - best_.begin()), node_ = best->node;
            flying_ = best->missing;
            load(node_);
        }
        ++shots_;
        return true;
    }

    // The radiance of a node and of all below it, which counts as sent from now on; of a node with
    // children its mean.
    rgb load(uint32_t i) {
        const Node& n = tree_[i];
        Corners& L = radiance_[i];
        // exercise R.1
        if (n.children == 0) {
            const Face& f = mesh_.faces[side_ / 2];
            const size_t own = 2 * size_t(n.first) + side_ % 2;
            const Corners M = exitance(f, n.first, side_ % 2);
            for (size_t k = 0; k < 3; ++k) L[k] = (M[k] - shot_[own][k]) / pi;
            shot_[own] = M;
            sent_[own] = double(mean_of(M.mean()));
            return L.mean();
        }
        rgb sum;
        for (uint32_t k = n.first; k < n.first + n.children; ++k) sum += load(k) * tree_[k].area;
        L.fill(sum / n.area);
        return L[0];
        // end
    }

    // ---- Receivers ------------------------------------------------------------------------------

    // All vertices of a face.  Returns the number of shadow rays.
    uint64_t receive(uint32_t face) {
        const Face& f = mesh_.faces[face];
        const bool shoots = !point_ && face == side_ / 2;
        Transfer transfer(scene_);
        for (const bool back : {false, true}) {
            const vec3 n = back ? -f.n : f.n;
            Receiver to{{{}, n, f.error}, frame(n)};
            bool changed = shoots;
            for (uint32_t v = f.vertex; !shoots && v < f.vertex + f.vertices(); ++v) {
                if (v % 64 == 0 && cut_short()) return transfer.rays;
                to.x.p = mesh_.at[v];
                to.E = mean_of(map_[2 * v + back]);
                const rgb E = point_ ? transfer.from_point(to, *point_) : from_side(to, transfer);
                if (!(max_of(E) <= 0)) map_[2 * v + back] += E, changed = true;
            }
            if (changed) best_[2 * face + back] = candidate(2 * face + back);
        }
        return transfer.rays;
    }

    // A face does not see itself, nor anything in its plane.
    rgb from_side(const Receiver& to, Transfer& transfer) const {
        const Face& f = mesh_.faces[side_ / 2];
        const Source from{side_ % 2 ? -f.n : f.n, f.error};
        if (!(dot(to.x.p - f.a, from.n) > f.error + to.x.error)) return {};
        return from_node(to, from, node_, transfer);
    }

    // A node with children is taken as a whole if the vertex sees it under a small angle, or if it
    // is faint beside what the vertex has (brightness-weighted refinement, Hanrahan et al. 1991).
    // A vertex that is still dark may lie within a solid, so it is tested for visibility first.
    rgb from_node(const Receiver& to, const Source& from, uint32_t i, Transfer& transfer) const {
        const Node& node = tree_[i];
        const Corners& L = radiance_[i];
        if (behind(to, node)) return {};
        if (shooter_ == Shooter::face && max_from(to, node, mean_of(L.mean())) < faint_to(to)) {
            if (to.E > 0) return transfer.from_whole(to, from, node, L.mean(), 1);
            if (transfer.visible_part(to, from, node, 4) == 0) return {};
        }
        if (node.children == 0) return transfer.from_element(to, from, node, L);
        if (!near(to, node, 8)) return transfer.from_whole(to, from, node, L.mean(), 1);
        rgb E;
        for (uint32_t k = node.first; k < node.first + node.children; ++k)
            E += from_node(to, from, k, transfer);
        return E;
    }

    // Irradiance that is negligible at a vertex; at a dark one, relative to the mean of the scene.
    real faint_to(const Receiver& to) const {
        constexpr real part = real(0.005);  // by measurement: 0.1 % of an image of a furnished room
        return part * (to.E > 0 ? to.E : real(emitted_ / area_));
    }

    bool cut_short() const { return interrupted || std::chrono::steady_clock::now() > deadline_; }
};

}  // namespace penumbra
