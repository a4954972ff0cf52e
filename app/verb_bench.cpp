// incise bench: how fast this machine computes forces, steps and edits.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>

#include "app/progress.h"
#include "app/throughput.h"
#include "app/verbs.h"
#include "io/atomic_file.h"

namespace incise::app {

namespace {

using nlohmann::ordered_json;

ordered_json as_json(const Throughput& throughput) {
    const MachineSpeed& machine = throughput.machine;
    ordered_json json;
    json["version"] = INCISE_VERSION;
    json["machine"] = {{"processor", machine.processor},
                       {"instructions", machine.instructions},
                       {"cores", machine.num_cores},
                       {"gflops", machine.gigaflops},
                       {"gbytes_per_second", machine.gigabytes_per_second}};
    json["tissue"] = throughput.tissue;
    json["steps"] = ordered_json::array();
    for (const StepRate& rate : throughput.steps) {
        ordered_json row = {{"method", rate.method},
                            {"law", rate.law.empty() ? ordered_json(nullptr) : rate.law},
                            {"elements", rate.elements},
                            {"threads", rate.num_threads},
                            {"forces_ns_per_element", rate.forces},
                            {"step_ns_per_element", rate.step},
                            {"single_forces_ns_per_element", rate.single_forces},
                            {"single_step_ns_per_element", rate.single_step},
                            {"reference_ns_per_element", nullptr},
                            {"steps_per_second", rate.steps_per_second},
                            {"real_time_factor", rate.real_time_factor},
                            {"gflops", rate.gigaflops},
                            {"gbytes_per_second", rate.gigabytes_per_second}};
        if (rate.reference) row["reference_ns_per_element"] = *rate.reference;
        json["steps"].push_back(std::move(row));
    }
    json["edits"] = ordered_json::array();
    for (const EditRate& rate : throughput.edits)
        json["edits"].push_back({{"kind", rate.kind},
                                 {"elements", rate.elements},
                                 {"items", rate.items},
                                 {"microseconds_per_item", rate.microseconds}});
    json["halved"] = ordered_json::array();
    for (const HalvedRate& rate : throughput.halved)
        json["halved"].push_back({{"elements", rate.elements},
                                  {"elements_left", rate.elements_left},
                                  {"nodes", rate.nodes},
                                  {"nodes_left", rate.nodes_left},
                                  {"forces_ns_per_element", rate.forces},
                                  {"forces_left_ns_per_element", rate.forces_left},
                                  {"forces_built_anew_ns_per_element", rate.forces_built_anew}});
    return json;
}

void print_text(const Throughput& throughput) {
    const MachineSpeed& machine = throughput.machine;
    std::printf("processor   %s, %d cores, instructions: %s\n", machine.processor.c_str(),
                machine.num_cores, std::string(machine.instructions).c_str());
    std::printf(
        "limits      %.1f GFLOP/s (doubles, not fused), %.1f GB/s from memory, on one core\n",
        machine.gigaflops, machine.gigabytes_per_second);
    std::printf("bodies      cubes of 10 cm with the stiffness of %s\n\n",
                std::string(throughput.tissue).c_str());
    std::printf("%-22s %8s %7s | %9s %9s %11s | %8s %9s | %7s %6s | %9s %9s\n", "law", "elements",
                "threads", "forces", "step", "reference", "steps/s", "real time", "GFLOP/s", "GB/s",
                "forces in", "step in");
    std::printf("%-22s %8s %7s | %9s %9s %11s | %8s %9s | %7s %6s | %9s %9s\n", "", "", "",
                "ns/elem.", "ns/elem.", "forces, ns", "", "factor", "", "", "single", "single");
    for (const StepRate& rate : throughput.steps) {
        char reference[16] = "";
        if (rate.reference) std::snprintf(reference, sizeof reference, "%.1f", *rate.reference);
        const auto name = std::string(rate.law.empty() ? rate.method : rate.law);
        std::printf("%-22s %8zu %7d | %9.2f %9.2f %11s | %8.0f %9.3g | %7.1f %6.1f | %9.2f %9.2f\n",
                    name.c_str(), rate.elements, rate.num_threads, rate.forces, rate.step,
                    reference, rate.steps_per_second, rate.real_time_factor, rate.gigaflops,
                    rate.gigabytes_per_second, rate.single_forces, rate.single_step);
    }
    std::printf("\n%-22s %8s %7s | %9s\n", "edit", "elements", "items", "us/item");
    for (const EditRate& rate : throughput.edits)
        std::printf("%-22s %8zu %7zu | %9.2f\n", std::string(rate.kind).c_str(), rate.elements,
                    rate.items, rate.microseconds);
    std::printf("\n%-22s %8s %7s | %9s %9s %11s | %8s %8s\n", "a random half removed", "elements",
                "left", "forces", "of these", "built anew", "nodes", "left");
    std::printf("%-22s %8s %7s | %9s %9s %11s |\n", "", "", "", "ns/elem.", "ns/elem.", "ns/elem.");
    for (const HalvedRate& rate : throughput.halved)
        std::printf("%-22s %8zu %7zu | %9.2f %9.2f %11.2f | %8zu %8zu\n", "", rate.elements,
                    rate.elements_left, rate.forces, rate.forces_left, rate.forces_built_anew,
                    rate.nodes, rate.nodes_left);
}

}  // namespace

int bench(const BenchOptions& options) {
    if (options.json && *options.json != "-") io::require_writable(*options.json);
    Throughput throughput;
    {
        Progress progress(1.0, "measuring", false);
        throughput = measure_throughput(
            {}, [&](double share, const std::string& part) { progress.update(share, part); });
        progress.finish();
    }
    if (!options.json) {
        print_text(throughput);
        return done;
    }
    const auto text =
        as_json(throughput).dump(2, ' ', false, ordered_json::error_handler_t::replace) + '\n';
    if (*options.json == "-")
        std::cout << text;
    else
        io::write_file(*options.json, text);
    return done;
}

}  // namespace incise::app
