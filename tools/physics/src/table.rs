//! Tables of the stored figures: a text table of all figures of a robot, and a Markdown table with one row per gait.

use std::fmt::Write as _;

use lizard_robot::Robot;

use crate::case::{Case, Feet, Legs};
use crate::figures::{Displacement, Figures};

/// The displacement per cycle up to which a component counts as zero: mm ahead, and deg of turn.
const NEGLIGIBLE_DISPLACEMENT: (f64, f64) = (1.0, 0.5);

/// A component of a displacement: the distance ahead, or the turn.
#[derive(Clone, Copy)]
pub(crate) enum Component {
    Ahead,
    Turn,
}

impl Component {
    /// Returns the components of a displacement that are not negligible; `Ahead` if both are negligible.
    pub(crate) fn of(displacement: Displacement) -> Vec<Self> {
        let [ahead, _, turn] = displacement.0.map(f64::abs);
        let mut components = Vec::new();
        if ahead > NEGLIGIBLE_DISPLACEMENT.0 || turn <= NEGLIGIBLE_DISPLACEMENT.1 {
            components.push(Self::Ahead);
        }
        if turn > NEGLIGIBLE_DISPLACEMENT.1 {
            components.push(Self::Turn);
        }
        components
    }

    pub(crate) fn unit(self) -> &'static str {
        match self {
            Self::Ahead => "mm",
            Self::Turn => "deg",
        }
    }

    pub(crate) fn value(self, displacement: Displacement) -> f64 {
        match self {
            Self::Ahead => displacement.0[0],
            Self::Turn => displacement.0[2],
        }
    }
}

/// Returns a table of all figures of a robot as plain text, with the model and MuJoCo side by side and one block for
/// each kind of legs.
pub fn table(name: &str, robot: &Robot, figures: &Figures) -> String {
    let mut text = String::new();
    for legs in [Legs::Rigid, Legs::Strut] {
        let title = match legs {
            Legs::Rigid => "rigid struts",
            Legs::Strut => "struts with springs",
        };
        _ = writeln!(text, "robots/{name}.toml, {title}");
        let cases = Feet::ALL.map(|feet| Case { legs, feet });
        let cases: Vec<Case> = cases
            .into_iter()
            .filter(|case| Case::ALL.contains(case))
            .collect();
        let width = moving_gait_names(robot).map(str::len).max().unwrap_or(0);
        _ = write!(text, "{:width$}    ", "");
        let headings = cases.iter().map(|case| match case.feet {
            Feet::Level => "level",
            Feet::Stiff => "0.6 mm long, 2 N/mm",
            Feet::Soft => "1.0 mm long",
        });
        for head in headings {
            _ = write!(text, "  {head:<20}");
        }
        text = text.trim_end().to_owned();
        _ = write!(text, "\n{:<width$}    ", "gait");
        for _ in &cases {
            _ = write!(text, "  {:>6}  {:>6}      ", "model", "MuJoCo");
        }
        text = text.trim_end().to_owned() + "\n";
        for gait in moving_gait_names(robot) {
            let Some(first_results) = figures.get(name, gait, cases[0]) else {
                continue;
            };
            for component in Component::of(first_results.model.unwrap_or(first_results.mujoco)) {
                _ = write!(text, "{gait:<width$} {:>3}", component.unit());
                for results in cases
                    .iter()
                    .filter_map(|case| figures.get(name, gait, *case))
                {
                    for displacement in [results.model, Some(results.mujoco)] {
                        _ = match displacement {
                            Some(displacement) => {
                                write!(text, "  {:>+6.1}", component.value(displacement))
                            }
                            None => write!(text, "  {:>6}", "-"),
                        };
                    }
                    text.push_str("      ");
                }
                text = text.trim_end().to_owned() + "\n";
            }
        }
        text.push('\n');
    }
    text.trim_end().to_owned() + "\n"
}

/// Returns the names of the gaits that move, in the order of robot.toml.
fn moving_gait_names(robot: &Robot) -> impl Iterator<Item = &str> {
    let moving = robot.gaits().iter().filter(|gait| gait.has_movement());
    moving.map(|gait| gait.name())
}

/// Returns the displacement per cycle of each gait as a Markdown table. For level feet: the model's prediction with
/// ideal servos and with the robot's servos, and MuJoCo's result. For a foot 1.0 mm too long: the range from the
/// model's prediction with ideal servos to MuJoCo's result.
pub fn displacement_table(name: &str, robot: &Robot, figures: &Figures) -> String {
    let mut text = "| gait | cycle, s | ideal servos | its servos | MuJoCo | ideal servos and MuJoCo, a foot 1.0 mm too long |\n|---|---|---|---|---|---|\n".to_owned();
    for gait in robot.gaits().iter().filter(|gait| gait.has_movement()) {
        let results_with = |feet: Feet| {
            let legs = Legs::Rigid;
            figures.get(name, gait.name(), Case { legs, feet })
        };
        let (Some(level), Some(long_foot)) = (results_with(Feet::Level), results_with(Feet::Soft))
        else {
            continue;
        };
        let (Some(model), Some(long_model)) = (level.model, long_foot.model) else {
            continue;
        };
        let cell_of = |displacements: &[Displacement]| {
            let components = Component::of(model)
                .into_iter()
                .map(|component| range_text(component, displacements));
            components.collect::<Vec<_>>().join(", ")
        };
        _ = writeln!(
            text,
            "| {} | {} | {} | {} | {} | {} |",
            gait.name(),
            gait.period(),
            cell_of(&[model]),
            cell_of(&[gait
                .simulate_driven_cycle(robot.ground(), &robot.motors(), 1.0)
                .into()]),
            cell_of(&[level.mujoco]),
            cell_of(&[long_model, long_foot.mujoco])
        );
    }
    text
}

fn range_text(component: Component, displacements: &[Displacement]) -> String {
    let values = displacements
        .iter()
        .map(|displacement| component.value(*displacement));
    let smallest = values.clone().fold(f64::INFINITY, f64::min);
    let largest = values.fold(f64::NEG_INFINITY, f64::max);
    let ([smallest, largest], unit) = (
        [smallest, largest].map(|value| format!("{value:+.1}")),
        component.unit(),
    );
    match smallest == largest {
        true => format!("{smallest} {unit}"),
        false => format!("{smallest} to {largest} {unit}"),
    }
}
