#include "cli/stats_writer.h"

#include <string_view>

namespace weft::cli {
namespace {

constexpr std::string_view kHeader =
    "frame,time,level,substeps,milliseconds,kinetic_energy,potential_energy,max_strain,max_"
    "compression,mean_strain,nodes_in_contact,energy_lost,energy_given_back,effects_work,contact_took";

}  // namespace

StatsWriter::StatsWriter(const std::string& path, bool several_cloths)
    : file_(path), several_cloths_(several_cloths) {
  file_.write(kHeader);
  file_.write(several_cloths ? ",cloth\n" : "\n");
}

void StatsWriter::write(int frame, const Simulation<float>& simulation) {
  constexpr double kMilliseconds = 1e3;
  for (std::size_t cloth = 0; cloth < simulation.cloths().size(); ++cloth) {
    const ClothReport report = simulation.report(cloth);
    std::string line;
    const auto field = [&line](auto value) {
      if (!line.empty()) line += ',';
      append_number(line, value);
    };
    field(frame);
    field(simulation.time());
    field(report.level);
    field(report.substeps);
    field(simulation.profile().total * kMilliseconds);
    field(report.kinetic_energy);
    field(report.potential_energy);
    field(report.strain.max);
    field(report.strain.max_compression);
    field(report.strain.mean);
    field(report.nodes_in_contact);
    const AdvanceReport& step = simulation.last_advance(cloth);
    field(step.energy_lost);
    field(step.energy_given_back);
    field(step.effects_work);
    field(step.contact_took);
    if (several_cloths_) line += "," + simulation.cloths()[cloth].description().name;
    file_.write(line + '\n');
  }
}

}  // namespace weft::cli
