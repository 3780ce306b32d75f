//! `lizard design`: the paper's dimensional synthesis (performance-chart-based design methodology), and a search for
//! better designs.

use std::io::{self, BufWriter, Write};

use lizard_paper::design::{
    BestValues, CLAIMED_LCI, ChartPoint, Design, LciStatistics, PROPORTION_SUM, Performance,
    Proportions, Requirements, Search, compute_chart_points, find_design, grid_points,
    merge_and_rank,
};
use lizard_robot::Robot;
use serde::{Deserialize, Serialize};

use crate::Failure;
use crate::shared::json;
use crate::shared::number::{range_parser, whole_number_parser};
use crate::shared::progress::create_progress_bar;
use crate::shared::quantity::Quantity;
use crate::shared::spread::{SpreadArgs, Spreadable};

/// Number of sampling rings in the inscribed circle of a single design.
const FINE_RING_COUNT: usize = 128;
/// Number of sampling rings in the inscribed circles of many designs.
const COARSE_RING_COUNT: usize = 32;

/// Dimensional synthesis of the head and tail five-bar
///
/// Takes the non-dimensional links r1, r2, r3 (crank, coupler, half base; their sum is
/// 0.9) and the base l0; the defaults are the paper's values. Prints the workspace, the
/// maximal inscribed circle (MIC), the local conditioning index (LCI) in the circle, the
/// dimensional factor D and the link table.
#[derive(clap::Args, Serialize, Deserialize)]
#[command(
    allow_negative_numbers = true,
    after_help = "Examples:
  lizard design
  lizard design --r1 0.35 --r2 0.4 --l0 24
  lizard design --chart > chart.csv
  lizard design --search"
)]
pub struct Args {
    /// Distance between the two servo shafts, mm [default: 20]
    #[arg(long, value_name = "MM", value_parser = parse_base)]
    l0: Option<f64>,
    /// Crank; give two or three of r1, r2, r3, or none [default: 0.3]
    #[arg(long, value_parser = Quantity::PROPORTION.parser())]
    r1: Option<f64>,
    /// Coupler [default: 0.5]
    #[arg(long, value_parser = Quantity::PROPORTION.parser())]
    r2: Option<f64>,
    /// Half the base [default: 0.1]
    #[arg(long, value_parser = Quantity::PROPORTION.parser())]
    r3: Option<f64>,
    /// Print the performance charts over the whole design space, as CSV
    #[arg(long, group = "grid", conflicts_with_all = ["sweep", "shortest", "top"])]
    chart: bool,
    /// Rank all designs that stay within the servos' travel, the margins and the sliders' stroke
    #[arg(long, group = "grid")]
    search: bool,
    /// Grid step of --chart and --search
    #[arg(long, requires = "grid", default_value_t = 0.02, value_parser = range_parser(0.002, 0.2, ""))]
    step: f64,
    /// Sweep that --search requires of every servo, degrees to either side
    #[arg(long, requires = "search", default_value_t = 20.0, value_parser = range_parser(1.0, 60.0, " degrees"))]
    sweep: f64,
    /// Shortest link that --search allows, mm; two M3 joints need about this length
    #[arg(long, requires = "search", default_value_t = 20.0, value_name = "MM",
          value_parser = Quantity::LENGTH.parser())]
    shortest: f64,
    /// Number of designs that --search prints
    #[arg(long, requires = "search", default_value_t = 12, value_parser = whole_number_parser(0, usize::MAX))]
    top: usize,
    /// Print JSON instead of text
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    #[serde(skip)]
    spread: SpreadArgs,
}

impl Spreadable for Args {
    const COMMAND: &'static str = "design";

    fn spread_args(&mut self) -> &mut SpreadArgs {
        &mut self.spread
    }
}

fn parse_base(text: &str) -> Result<f64, String> {
    match Quantity::LENGTH.parser()(text) {
        Ok(l0) if l0 < 0.001 => Err("must be at least 0.001 mm".to_string()),
        result => result,
    }
}

/// Prints the synthesis, the chart points or the ranking.
///
/// # Errors
/// Fails if robot.toml is invalid, if the proportions are outside the design space, if `--part` is given without
/// `--search`, or if the output cannot be written.
pub fn run(args: Args) -> Result<(), Failure> {
    if args.spread.part().is_some() && !args.search {
        return Err(Failure::Input("--part requires --search".to_owned()));
    }
    let proportions = args.complete_proportions().map_err(Failure::Input)?;
    let l0 = args.l0.unwrap_or(20.0);
    let robot = args.spread.robot.load()?;
    if !args.chart && !args.search {
        let report = Report::new(proportions, l0);
        return json::print_json_or_text(args.json, &report, || report.to_text(&robot));
    }
    let mut out = BufWriter::new(io::stdout().lock());
    match args.chart {
        true => print_chart_points(&args, &mut out)?,
        false => print_ranking(&args, &robot, l0, proportions, &mut out)?,
    }
    Ok(out.flush()?)
}

impl Args {
    /// Returns the given proportions. A missing one follows from their sum. If none is given, they are the paper's.
    fn complete_proportions(&self) -> Result<Proportions, String> {
        match (self.r1, self.r2, self.r3) {
            (None, None, None) => Ok(Proportions::PAPER),
            (Some(r1), Some(r2), Some(r3)) => Proportions::new(r1, r2, r3),
            (Some(r1), Some(r2), None) => Proportions::new(r1, r2, PROPORTION_SUM - r1 - r2),
            (Some(r1), None, Some(r3)) => Proportions::new(r1, PROPORTION_SUM - r1 - r3, r3),
            (None, Some(r2), Some(r3)) => Proportions::new(PROPORTION_SUM - r2 - r3, r2, r3),
            _ => Err("give two or three of --r1, --r2, --r3, or none".to_string()),
        }
    }
}

/// The report on one design, with lengths in mm; the field names are the JSON keys.
#[derive(Serialize)]
struct Report {
    #[serde(flatten)]
    proportions: Proportions,
    /// Dimensional factor D.
    d: f64,
    l0: f64,
    l1: f64,
    l2: f64,
    #[serde(flatten)]
    performance: Performance,
}

impl Report {
    fn new(proportions: Proportions, l0: f64) -> Self {
        let d = proportions.factor_for_base(l0);
        let five_bar = proportions.five_bar(d);
        Self {
            proportions,
            d,
            l0: five_bar.base,
            l1: five_bar.left_crank_length,
            l2: five_bar.left_coupler_length,
            performance: Performance::compute(&five_bar, FINE_RING_COUNT),
        }
    }

    fn to_text(&self, robot: &Robot) -> String {
        let Proportions { r1, r2, r3 } = self.proportions;
        let performance = &self.performance;
        let mut text = format!(
            "design space   r1 {r1:.4}   r2 {r2:.4}   r3 {r3:.4}   sum {:.4}   0 < r1, r2 < 0.9 and 0 < r3 < 0.45: yes
scale          D = R3 / r3 = {:.3} / {r3:.4} = {:.3} mm
workspace      {:.1} mm^2, upper half {:.1} mm^2; rings of {:.2} to {:.2} mm about each shaft
",
            r1 + r2 + r3,
            self.l0 / 2.0,
            self.d,
            performance.area,
            performance.area / 2.0,
            (self.l1 - self.l2).abs(),
            self.l1 + self.l2,
        );
        match &performance.lci {
            None => {
                text +=
                    "MIC            none: half the base is longer than crank and coupler together\n"
            }
            Some(lci) => {
                text += &format!(
                    "MIC            radius {:.3} mm ({:.3} D), centre (0, {:.3}) mm
LCI in MIC     mean {:.3}, least {:.3}, most {:.3}; above {CLAIMED_LCI} on {:.1} % of the area
",
                    performance.r_mic,
                    performance.r_mic / self.d,
                    performance.y_mic,
                    lci.mean,
                    lci.min,
                    lci.max,
                    100.0 * lci.share_above,
                );
                text += &format_claim_verdict(lci, performance.r_mic);
            }
        }
        let (links, leg) = (robot.lizard().links, robot.lizard().leg);
        text += &format!(
            "
link                          mm   from
l0, l5                  {:8.2}   the servos' size
l1, l4, l6, l9          {:8.2}   r1 D
l2, l3, l7, l8          {:8.2}   r2 D
l11, l14, l16, l19      {:8.2}   side arms, as long as the cranks, at C = 90 deg to them
l12, l13, l17, l18      {:8.2}   robot.toml; the paper gives no rule
l10, l15                {:8.2}   robot.toml; the paper gives no rule
lg10, lg12              {:8.2}   robot.toml; the paper gives no rule
lg1, lg13               {:8.2}   robot.toml; the paper gives no rule
",
            self.l0, self.l1, self.l2, self.l1, links.l12, links.l10, leg.ground, leg.crank
        );
        text
    }
}

/// Formats the line about the paper's claim "LCI > 0.7".
fn format_claim_verdict(lci: &LciStatistics, r_mic: f64) -> String {
    let [mean_verdict, bound_verdict] = [lci.mean, lci.min].map(|lci| match lci > CLAIMED_LCI {
        true => "holds",
        false => "fails",
    });
    format!(
        "\"LCI > {CLAIMED_LCI}\"    {mean_verdict} as a mean, {bound_verdict} as a bound; as a bound it holds within {:.2} mm of the centre ({:.0} % of the radius)\n",
        lci.radius_above,
        100.0 * lci.radius_above / r_mic,
    )
}

/// Computes the points of the performance charts on a grid of `step`, and shows a progress bar.
pub fn compute_points(step: f64, ring_count: usize) -> Vec<ChartPoint> {
    let points = grid_points(step);
    let template = "performance charts {bar:40} {pos}/{len} {eta}";
    let bar = create_progress_bar(points.len(), template);
    compute_chart_points(points, ring_count, &|| bar.inc(1))
}

fn print_chart_points(args: &Args, out: &mut impl Write) -> Result<(), Failure> {
    let points = compute_points(args.step, COARSE_RING_COUNT);
    if args.json {
        return Ok(json::write_line(out, &points)?);
    }
    writeln!(
        out,
        "r1,r2,r3,area,r_mic,y_mic,lci_mean,lci_least,lci_most,share_above_0.7,radius_above_0.7"
    )?;
    for point in points {
        let Proportions { r1, r2, r3 } = point.proportions;
        let performance = point.performance;
        write!(
            out,
            "{r1:.4},{r2:.4},{r3:.4},{:.6},{:.6},{:.6}",
            performance.area, performance.r_mic, performance.y_mic
        )?;
        match performance.lci {
            Some(lci) => writeln!(
                out,
                ",{:.6},{:.6},{:.6},{:.6},{:.6}",
                lci.mean, lci.min, lci.max, lci.share_above, lci.radius_above
            )?,
            None => writeln!(out, ",,,,,")?,
        }
    }
    Ok(())
}

fn print_ranking(
    args: &Args,
    robot: &Robot,
    l0: f64,
    given_proportions: Proportions,
    out: &mut impl Write,
) -> Result<(), Failure> {
    let travels = robot.servos().iter().map(|servo| {
        let (min_angle, max_angle) = servo.travel();
        max_angle.min(-min_angle)
    });
    let requirements = Requirements {
        base_mm: l0,
        chassis_length_mm: robot.lizard().links.l10,
        leg_crank_mm: robot.lizard().leg.crank,
        limits: *robot.limits(),
        travel_deg: travels.fold(f64::INFINITY, f64::min),
        min_link_mm: args.shortest,
        sweep_deg: args.sweep,
    };
    let search = Search::new(args.step, requirements);
    let point_count = search.point_count(args.spread.count_own_pieces(search.piece_count()));
    let bar = create_progress_bar(point_count, "designs {bar:40} {pos}/{len} {eta}");
    let search_piece = |index| search.compute_piece(index, &|| bar.inc(1));
    let pieces = args
        .spread
        .run_pieces(args, search.piece_count(), search_piece)?;
    bar.finish_and_clear();
    let Some(pieces) = pieces else {
        return Ok(());
    };
    let designs = merge_and_rank(pieces);
    let top_designs = &designs[..designs.len().min(args.top)];
    let given_design = find_design(given_proportions, &requirements);
    if args.json {
        return Ok(json::write_line(out, &top_designs)?);
    }
    writeln!(
        out,
        "{} of {} designs keep every margin and the stroke with all servos anywhere within +-{:.0} deg\n\
         and have no link shorter than {:.0} mm.\n\
         Ranked by mean LCI, least margin (both within that sweep) and stride (with the widest safe sweep);\n\
         * none is better in all three. Base l0 {l0} mm.\n",
        designs.len(),
        grid_points(args.step).len(),
        args.sweep,
        args.shortest
    )?;
    writeln!(
        out,
        "rank     r1     r2     r3   crank  coupler mm   theta1  sweep deg   LCI  margin  stride mm  score"
    )?;
    let write_row = |out: &mut dyn Write, rank: &str, design: &Design| {
        let Proportions { r1, r2, r3 } = design.proportions;
        writeln!(
            out,
            "{rank:>4} {r1:6.3} {r2:6.3} {r3:6.3} {:7.1} {:11.1} {:8.0} {:10.1} {:5.3} {:7.3} {:10.1} {:6.3}{}",
            r1 * design.d,
            r2 * design.d,
            design.neutral,
            design.sweep,
            design.lci,
            design.margin,
            design.stride,
            design.score,
            if design.is_pareto_optimal { " *" } else { "" }
        )
    };
    for (i, design) in top_designs.iter().enumerate() {
        write_row(out, &(i + 1).to_string(), design)?;
    }
    match given_design {
        None => writeln!(
            out,
            "\nThe given design (r1 {}, r2 {}, r3 {}) does not meet these requirements.",
            given_proportions.r1, given_proportions.r2, given_proportions.r3
        )?,
        Some(mut given_design) => {
            // The given design may have the best value of a criterion.
            let best_values = BestValues::from_designs(designs.iter().chain([&given_design]));
            given_design.score = best_values.score(&given_design);
            let is_better = |design: &&Design| design.score > given_design.score + 1e-9;
            let rank = 1 + designs.iter().filter(is_better).count();
            writeln!(out, "\nthe given design:")?;
            write_row(out, &rank.to_string(), &given_design)?;
        }
    }
    Ok(())
}
