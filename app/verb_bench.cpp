// incise bench: measures how fast the machine computes forces, steps and edits.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>

#include "incise/app/progress.h"
#include "incise/app/verbs.h"
#include "incise/bench/throughput.h"
#include "incise/io/files/atomic_file.h"

namespace incise::app {

namespace {

using nlohmann::ordered_json;

ordered_json row_of(const bench::StepRate& rate) {
    ordered_json row = {{"method", rate.method},
                        {"law", rate.law.empty() ? ordered_json(nullptr) : rate.law},
                        {"elements", rate.elements},
                        {"threads", rate.num_threads},
                        {"forces_ns_per_element", rate.forces},
                        {"step_ns_per_element", rate.step},
                        {"single_forces_ns_per_element", rate.single_forces},
                        {"single_step_ns_per_element", rate.single_step},
                        {"reference_ns_per_element", nullptr},
                        {"reference_step_over_step", nullptr},
                        {"arithmetic_ns_per_element", nullptr},
                        {"step_over_arithmetic", nullptr},
                        {"microseconds_per_step", 1e6 / rate.steps_per_second},
                        {"steps_per_second", rate.steps_per_second},
                        {"real_time_factor", rate.real_time_factor},
                        {"gflops", rate.gigaflops},
                        {"gbytes_per_second", rate.gigabytes_per_second},
                        {"share_of_peak", rate.share_of_peak},
                        {"share_of_bandwidth", rate.share_of_bandwidth}};
    if (rate.reference) row["reference_ns_per_element"] = *rate.reference;
    if (rate.reference_ratio) row["reference_step_over_step"] = *rate.reference_ratio;
    if (rate.arithmetic) {
        row["arithmetic_ns_per_element"] = *rate.arithmetic;
        row["step_over_arithmetic"] = rate.step / *rate.arithmetic;
    }
    return row;
}

ordered_json as_json(const bench::Throughput& throughput) {
    const bench::MachineSpeed& machine = throughput.machine;
    ordered_json json;
    json["version"] = INCISE_VERSION;
    json["machine"] = {{"processor", machine.processor},
                       {"instructions", machine.instructions},
                       {"cores", machine.num_cores},
                       {"limits", ordered_json::array()}};
    for (const auto& [threads, limit] : machine.limits)
        json["machine"]["limits"].push_back({{"threads", threads},
                                             {"gflops", limit.gigaflops},
                                             {"gbytes_per_second", limit.gigabytes_per_second}});
    json["tissue"] = throughput.tissue;
    json["steps"] = ordered_json::array();
    for (const bench::StepRate& rate : throughput.steps) json["steps"].push_back(row_of(rate));
    json["edits"] = ordered_json::array();
    for (const bench::EditRate& rate : throughput.edits)
        json["edits"].push_back({{"method", rate.method},
                                 {"kind", rate.kind},
                                 {"item", rate.item},
                                 {"elements", rate.elements},
                                 {"items", rate.items},
                                 {"microseconds_per_item", rate.microseconds}});
    json["edited"] = ordered_json::array();
    for (const bench::EditedRate& rate : throughput.edited)
        json["edited"].push_back({{"method", rate.method},
                                  {"edits", rate.edits},
                                  {"elements_before", rate.elements_before},
                                  {"elements", rate.elements},
                                  {"nodes_before", rate.nodes_before},
                                  {"nodes", rate.nodes},
                                  {"forces_before_ns_per_element", rate.forces_before},
                                  {"forces_ns_per_element", rate.forces},
                                  {"forces_built_anew_ns_per_element", rate.forces_built_anew}});
    json["contact"] = ordered_json::array();
    for (const bench::ContactRate& rate : throughput.contact)
        json["contact"].push_back({{"elements", rate.elements},
                                   {"points", rate.points},
                                   {"friction", rate.friction},
                                   {"step_without_contact_us", rate.step_without},
                                   {"step_us", rate.step},
                                   {"surface_nodes", rate.surface_nodes},
                                   {"search_ms", rate.search}});
    return json;
}

void print_text(const bench::Throughput& throughput) {
    const bench::MachineSpeed& machine = throughput.machine;
    std::printf("processor   %s, %d cores, instructions: %s\n", machine.processor.c_str(),
                machine.num_cores, std::string(machine.instructions).c_str());
    for (const auto& [threads, limit] : machine.limits)
        std::printf(
            "limits      %.1f GFLOP/s (doubles, fused), %.1f GB/s from memory, %d thread%s\n",
            limit.gigaflops, limit.gigabytes_per_second, threads, threads > 1 ? "s" : "");
    std::printf("bodies      cubes of 10 cm with the stiffness of %s\n\n",
                std::string(throughput.tissue).c_str());
    std::printf("%-22s %8s %7s | %9s %9s %11s %7s %10s | %9s %8s %9s | %7s %5s %6s %5s | %9s %9s\n",
                "law", "elements", "threads", "forces", "step", "reference", "step", "arithmetic",
                "step", "steps/s", "real time", "GFLOP/s", "of", "GB/s", "of", "forces in",
                "step in");
    std::printf("%-22s %8s %7s | %9s %9s %11s %7s %10s | %9s %8s %9s | %7s %5s %6s %5s | %9s %9s\n",
                "", "", "", "ns/elem.", "ns/elem.", "forces, ns", "over", "alone, ns", "us", "",
                "factor", "", "limit", "", "limit", "single", "single");
    const auto text = [](const std::optional<double>& value) {
        char digits[32] = "";
        if (value) std::snprintf(digits, sizeof digits, "%.1f", *value);
        return std::string(digits);
    };
    for (const bench::StepRate& rate : throughput.steps) {
        const auto name = std::string(rate.law.empty() ? rate.method : rate.law);
        std::printf(
            "%-22s %8zu %7d | %9.2f %9.2f %11s %7s %10s | %9.0f %8.0f %9.3g | %7.1f %4.0f%% %6.1f "
            "%4.0f%% | %9.2f %9.2f\n",
            name.c_str(), rate.elements, rate.num_threads, rate.forces, rate.step,
            text(rate.reference).c_str(), text(rate.reference_ratio).c_str(),
            text(rate.arithmetic).c_str(), 1e6 / rate.steps_per_second, rate.steps_per_second,
            rate.real_time_factor, rate.gigaflops, 100.0 * rate.share_of_peak,
            rate.gigabytes_per_second, 100.0 * rate.share_of_bandwidth, rate.single_forces,
            rate.single_step);
    }
    std::printf("\n%-6s %-10s %-16s %8s %7s | %9s\n", "method", "edit", "item", "elements", "items",
                "us/item");
    for (const bench::EditRate& rate : throughput.edits)
        std::printf("%-6s %-10s %-16s %8zu %7zu | %9.2f\n", std::string(rate.method).c_str(),
                    std::string(rate.kind).c_str(), std::string(rate.item).c_str(), rate.elements,
                    rate.items, rate.microseconds);
    std::printf("\n%-6s %-13s %8s %8s | %8s %8s | %13s %9s %11s\n", "method", "forces after",
                "elements", "then", "nodes", "then", "before, ns/e.", "then", "built anew");
    for (const bench::EditedRate& rate : throughput.edited)
        std::printf("%-6s %-13s %8zu %8zu | %8zu %8zu | %13.2f %9.2f %11.2f\n",
                    std::string(rate.method).c_str(), std::string(rate.edits).c_str(),
                    rate.elements_before, rate.elements, rate.nodes_before, rate.nodes,
                    rate.forces_before, rate.forces, rate.forces_built_anew);
    std::printf("\n%-16s %8s %8s | %15s %9s | %13s %9s\n", "closed cut", "points", "friction",
                "step without, us", "step, us", "surface nodes", "search, ms");
    for (const bench::ContactRate& rate : throughput.contact)
        std::printf("%-8zu elements %7zu %8.1f | %16.0f %9.0f | %13zu %10.1f\n", rate.elements,
                    rate.points, rate.friction, rate.step_without, rate.step, rate.surface_nodes,
                    rate.search);
}

}  // namespace

int bench(const BenchOptions& options) {
    if (options.json && *options.json != "-") io::require_writable(*options.json);
    bench::Throughput throughput;
    {
        Progress progress(1.0, "measuring", false);
        throughput = bench::measure_throughput(
            {}, [&](double share, const std::string& part) { progress.update(share, part); });
        progress.finish();
    }
    const auto text =
        as_json(throughput).dump(2, ' ', false, ordered_json::error_handler_t::replace) + '\n';
    if (options.json == "-") {
        std::cout << text;
        return done;
    }
    print_text(throughput);
    if (options.json) io::write_file(*options.json, text);
    return done;
}

}  // namespace incise::app
