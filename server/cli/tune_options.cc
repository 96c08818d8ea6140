#include <CLI/CLI.hpp>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gap/estimate/least_squares.h"
#include "server/cli/data_option.h"
#include "server/cli/tune_command.h"

namespace slipway::server {

void add_tune_command(CLI::App& app, std::function<int()>& run) {
  const auto options = std::make_shared<TuneCommand>();
  CLI::App* command = app.add_subcommand("tune", "tune a table's soil to where its drives really ended");
  command->add_option("table", options->table, "file of a table, or name of a shipped one")->required();
  add_data_option(*command, options->data, "rovers, soils and campaigns");
  command
      ->add_option("--measured", options->measured,
                   "folder of a campaign, or CSV with columns drive, x_m, y_m, yaw_deg")
      ->required();
  command
      ->add_option("--parameter", options->parameters,
                   "NAME=lowest..highest, with :log for steps of a ratio: soil.friction_angle_deg=28..40")
      ->required();
  command->add_option("--prior", options->priors, "NAME=mean,std: what is known besides, for least squares");
  command->add_option("--coarse", options->coarse, "values of each parameter in the coarse sweep")
      ->capture_default_str()
      ->check(CLI::Range(2, 1000));
  command->add_option("--fine", options->fine, "values of each parameter in the fine sweep")
      ->capture_default_str()
      ->check(CLI::Range(2, 1000));
  command->add_option("--drives", options->drives, "ids of drives, * and ? stand for anything");
  command->add_option("--position-scale-m", options->position_scale_m, "so far off counts 1")
      ->capture_default_str();
  command->add_option("--heading-scale-deg", options->heading_scale_deg, "so far off counts 1")
      ->capture_default_str();
  command->add_flag(
      "--scales-are-errors", options->scales_are_errors,
      "the scales are standard deviations; otherwise those are estimated from what is left over");
  const std::span<const std::string_view> losses = gap::robust_loss_names();
  command
      ->add_option("--loss", options->loss,
                   "what least squares makes of drives that are far off: none counts them in full, huber by "
                   "their size, cauchy hardly at all")
      ->capture_default_str()
      ->check(CLI::IsMember(std::vector<std::string>(losses.begin(), losses.end())));
  command
      ->add_option("--loss-scale", options->loss_scale,
                   "far off begins at so many times the noise; 1.345 for huber and 2.385 for cauchy where "
                   "not given")
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--within", options->within,
                   "a set serves a tilt up to so many times its best score there")
      ->capture_default_str();
  command->add_option("--good-enough", options->good_enough, "and up to this score in any case")
      ->capture_default_str();
  command->add_flag("--each-tilt", options->each_tilt, "least squares by the drives of each tilt, too");
  command->add_flag("--sweep-only", options->sweep_only, "no least squares");
  command->add_option("--threads", options->threads, "at once; 0: as many as the machine has")
      ->capture_default_str()
      ->check(CLI::Range(0, 1024));
  command->add_option("--out", options->out, "folder for tuning.json and the score surface; made if need be");
  command->add_flag("--json", options->json, "print the document, for machines");
  command->footer(
      "Example: which friction and which shear modulus bring simulated drives to where the real ones ended?\n"
      "  slipway tune fido_table_1 --measured fido --drives 'straight_*' --parameter "
      "soil.friction_angle_deg=28..44 --parameter soil.shear_modulus_m=0.005..0.025 --out tuned\n"
      "Exit status: 0 an answer, 1 none, 2 the question has faults; an unknown parameter lists those there "
      "are.");
  command->callback([options, &run] { run = [options] { return tune(*options); }; });
}

}  // namespace slipway::server
