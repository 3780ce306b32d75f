//! Tables of the stored results: a text table of all results of a robot, and a Markdown table with one row per gait.

use std::fmt::Write as _;

use lizard_robot::Robot;

use crate::case::{Case, FootSetup, LegDrive};
use crate::results::{Displacement, WalkResults};

/// The largest distance forward per cycle that counts as zero.
const NEGLIGIBLE_MM: f64 = 1.0;
/// The largest turn per cycle that counts as zero.
const NEGLIGIBLE_DEG: f64 = 0.5;

/// A component of a displacement: the distance forward, or the turn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Component {
    /// The distance forward, mm.
    Forward,
    /// The turn, deg counter-clockwise.
    Turn,
}

impl Component {
    /// Lists the components of a displacement that exceed `mm` forward or `deg` of turn.
    pub(crate) fn list_above(displacement: Displacement, mm: f64, deg: f64) -> Vec<Self> {
        let components = [(Self::Forward, mm), (Self::Turn, deg)].into_iter();
        let exceeds = |(component, max): &(Self, f64)| component.value(displacement).abs() > *max;
        let components = components.filter(exceeds);
        components.map(|(component, _)| component).collect()
    }

    /// Lists a displacement's components that are not negligible; `Forward` if both are negligible.
    fn list_relevant(displacement: Displacement) -> Vec<Self> {
        let components = Self::list_above(displacement, NEGLIGIBLE_MM, NEGLIGIBLE_DEG);
        match components.is_empty() {
            true => vec![Self::Forward],
            false => components,
        }
    }

    /// The component's unit.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Forward => "mm",
            Self::Turn => "deg",
        }
    }

    /// The component of a displacement, in its unit.
    pub fn value(self, displacement: Displacement) -> f64 {
        match self {
            Self::Forward => displacement.0[0],
            Self::Turn => displacement.0[2],
        }
    }
}

/// Returns a plain-text table of all results of a robot, with the model and MuJoCo side by side and one block for each
/// kind of leg drive.
pub fn format_comparison_table(name: &str, robot: &Robot, walk_results: &WalkResults) -> String {
    let mut lines = Vec::new();
    for legs in [LegDrive::Rigid, LegDrive::Strut] {
        let title = match legs {
            LegDrive::Rigid => "rigid struts",
            LegDrive::Strut => "struts with springs",
        };
        lines.push(format!("robots/{name}.toml, {title}"));
        let cases = Case::ALL.into_iter().filter(|case| case.legs == legs);
        let cases: Vec<Case> = cases.collect();
        let width = list_moving_gaits(robot).map(str::len).max().unwrap_or(0);
        let headings = cases.iter().map(|case| match case.feet {
            FootSetup::Level => "level",
            FootSetup::LongStiff => "foot +0.6 mm, 2 N/mm",
            FootSetup::Long => "foot +1.0 mm",
        });
        let headings: String = headings.map(|heading| format!("  {heading:<20}")).collect();
        lines.push(format!("{:width$}    {headings}", ""));
        let columns = "   model  MuJoCo      ".repeat(cases.len());
        lines.push(format!("{:<width$}    {columns}", "gait"));
        for gait in list_moving_gaits(robot) {
            let Some(first_results) = walk_results.get(name, gait, cases[0]) else {
                continue;
            };
            let first_displacement = first_results.model.unwrap_or(first_results.mujoco);
            for component in Component::list_relevant(first_displacement) {
                let mut line = format!("{gait:<width$} {:>3}", component.unit());
                let format_value = |displacement| format!("{:+.1}", component.value(displacement));
                let case_results = cases.iter().map(|case| walk_results.get(name, gait, *case));
                for results in case_results.flatten() {
                    let model = results.model.map_or("-".to_owned(), format_value);
                    let mujoco = format_value(results.mujoco);
                    _ = write!(line, "  {model:>6}  {mujoco:>6}      ");
                }
                lines.push(line);
            }
        }
        lines.push(String::new());
    }
    let lines: Vec<&str> = lines.iter().map(|line| line.trim_end()).collect();
    lines.join("\n").trim_end().to_owned() + "\n"
}

/// Returns the names of the moving gaits, in the order of robot.toml.
fn list_moving_gaits(robot: &Robot) -> impl Iterator<Item = &str> {
    let moving = robot.gaits().iter().filter(|gait| gait.has_movement());
    moving.map(|gait| gait.name())
}

/// Returns the displacement per cycle of each gait as a Markdown table. For level feet, the table has the model's
/// prediction with ideal servos and with the robot's servos, and MuJoCo's result. For a foot that is 1.0 mm too long,
/// it gives the model's prediction with ideal servos and MuJoCo's result as a range.
pub fn format_displacement_table(name: &str, robot: &Robot, walk_results: &WalkResults) -> String {
    let mut text = "| gait | cycle, s | ideal servos | the robot's servos | MuJoCo | ideal servos and MuJoCo, a foot 1.0 mm too long |\n|---|---|---|---|---|---|\n".to_owned();
    for gait in robot.gaits().iter().filter(|gait| gait.has_movement()) {
        let find_results = |feet: FootSetup| {
            let legs = LegDrive::Rigid;
            walk_results.get(name, gait.name(), Case { legs, feet })
        };
        let results = [FootSetup::Level, FootSetup::Long].map(find_results);
        let [Some(level), Some(long_foot)] = results else {
            continue;
        };
        let (Some(model), Some(long_model)) = (level.model, long_foot.model) else {
            continue;
        };
        let format_cell = |displacements: &[Displacement]| {
            let components = Component::list_relevant(model).into_iter();
            let ranges = components.map(|component| format_range(component, displacements));
            ranges.collect::<Vec<_>>().join(", ")
        };
        let driven = gait.simulate_driven_cycle(robot.ground(), &robot.motors(), 1.0);
        _ = writeln!(
            text,
            "| {} | {} | {} | {} | {} | {} |",
            gait.name(),
            gait.period(),
            format_cell(&[model]),
            format_cell(&[driven.into()]),
            format_cell(&[level.mujoco]),
            format_cell(&[long_model, long_foot.mujoco])
        );
    }
    text
}

fn format_range(component: Component, displacements: &[Displacement]) -> String {
    let unit = component.unit();
    let displacements = displacements.iter().copied();
    let values = displacements.map(|displacement| component.value(displacement));
    let smallest = values.clone().fold(f64::INFINITY, f64::min);
    let largest = values.fold(f64::NEG_INFINITY, f64::max);
    let [smallest, largest] = [smallest, largest].map(|value| format!("{value:+.1}"));
    match smallest == largest {
        true => format!("{smallest} {unit}"),
        false => format!("{smallest} to {largest} {unit}"),
    }
}
