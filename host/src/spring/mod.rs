//! `lizard spring`: does a spring from the shop make this robot walk?

mod geometry;

use std::io::{self, Write};

use lizard_robot::{Coil, Ground, Robot, Spring, Sprung};
use serde::Serialize;

use crate::json;
use crate::{Failure, RobotFile};
use geometry::{Geometry, Hung};

/// Turn a tension spring and its anchors into what the legs feel
///
/// The paper pulls each leg along by a tension spring and gives nothing but its size,
/// 5.55 x 25.4 mm. Whether the robot walks depends on it: each leg lags behind its servo
/// by the friction of its pad over the stiffness. This prints both, which gaits keep
/// 90 % of the way of rigid legs, and what would do.
#[derive(clap::Args, Debug)]
#[command(after_help = "Examples:
  lizard spring --wire 0.6
  lizard spring --wire 0.5 --geometry pair --radius 15
  lizard spring --wire 0.8 --outer 6 --length 20 --installed 24 --geometry radial

What it prints as `spring` and `preload` goes under [leg] in robot.toml.")]
pub struct Args {
    /// Diameter of the wire, mm
    #[arg(long, value_name = "MM", value_parser = length)]
    wire: f64,
    /// Outer diameter of the coil, mm
    #[arg(long, value_name = "MM", value_parser = length, default_value_t = 5.55)]
    outer: f64,
    /// Length inside the hooks without load, mm
    #[arg(long, value_name = "MM", value_parser = length, default_value_t = 25.4)]
    length: f64,
    /// Length inside the hooks where it is hung, mm
    #[arg(long, value_name = "MM", value_parser = length, default_value_t = 30.2)]
    installed: f64,
    /// From the leg's pivot to the anchor on the leg, mm
    #[arg(long, value_name = "MM", value_parser = length, default_value_t = 20.0)]
    radius: f64,
    /// How it is hung
    #[arg(long, value_enum, default_value_t)]
    geometry: Geometry,
    /// One JSON object
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    robot: RobotFile,
}

fn length(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (0.05..=500.0).contains(&value) => Ok(value),
        Ok(_) => Err("it must be within 0.05 to 500 mm".to_owned()),
        Err(_) => Err("it is not a number".to_owned()),
    }
}

/// What a gait must keep of its way.
const ENOUGH: f64 = 0.9;
/// The shear stress that spring wire bears for good, N/mm^2.
const BEARS: f64 = 800.0;

/// More than this (N) no printed lever and no servo shaft should bear.
const PULLS: f64 = 15.0;

/// What is known of a spring where it is hung.
#[derive(Debug, Serialize)]
struct Answer {
    /// N/mm
    rate: f64,
    /// N
    initial_tension: f64,
    /// N, where it is hung and the leg does not lag
    force: f64,
    /// N/mm^2, likewise
    stress: f64,
    /// What robot.toml calls `spring`, N mm/deg.
    spring: f64,
    /// What robot.toml calls `preload`, N mm.
    preload: f64,
    /// How far a pad gives that is pulled back with 50 g, mm.
    give_at_50_g: f64,
    gaits: Vec<GaitAnswer>,
}

#[derive(Debug, Serialize)]
struct GaitAnswer {
    gait: String,
    /// deg
    lag: f64,
    /// Of the way of rigid legs; null where that depends on ties.
    share: Option<f64>,
}

/// Computes and says.
///
/// # Errors
/// A spring that cannot be wound, or that is hung shorter than it is.
pub fn run(args: Args) -> Result<(), Failure> {
    let robot = args.robot.load()?;
    let coil = Coil {
        wire: args.wire,
        outer: args.outer,
        length: args.length,
    };
    if coil.outer < 3.0 * coil.wire {
        return Err(Failure::Input(format!(
            "a coil of {} mm is too narrow for a wire of {} mm: it needs three times that",
            coil.outer, coil.wire
        )));
    }
    if coil.coils() < 2.0 {
        return Err(Failure::Input(format!(
            "between its hooks a spring of {} mm has no room for two coils of this wire",
            coil.length
        )));
    }
    if args.installed < coil.length {
        return Err(Failure::Input(format!(
            "--installed is {} mm, but without load the spring is {} mm long already",
            args.installed, coil.length
        )));
    }
    let hung = Hung {
        coil,
        geometry: args.geometry,
        radius: args.radius,
        installed: args.installed,
    };
    let answer = Answer::of(&robot, &hung);
    let mut out = io::stdout().lock();
    if args.json {
        json::line(&mut out, &answer)?;
    } else {
        answer.print(&robot, &hung, &mut out)?;
    }
    Ok(out.flush()?)
}

/// The robot's ground with other springs.
fn on(robot: &Robot, spring: Spring) -> Ground {
    Ground {
        spring: Some(spring),
        ..*robot.ground()
    }
}

/// Whether every gait keeps enough of its way.
fn is_enough(robot: &Robot, spring: Spring) -> bool {
    let ground = on(robot, spring);
    let mut gaits = robot.gaits().iter().filter(|gait| gait.moves());
    gaits.all(|gait| {
        let share = Sprung::of(gait, &ground).and_then(|on| on.share);
        share.is_none_or(|share| share >= ENOUGH)
    })
}

impl Answer {
    fn of(robot: &Robot, hung: &Hung) -> Self {
        let spring = hung.spring();
        let ground = on(robot, spring);
        let reach = ground.feet.reach;
        let gaits = robot.gaits().iter().filter(|gait| gait.moves());
        let gaits = gaits.filter_map(|gait| {
            let Sprung { lag, share, .. } = Sprung::of(gait, &ground)?;
            Some(GaitAnswer {
                gait: gait.name().to_owned(),
                lag,
                share,
            })
        });
        Self {
            rate: hung.coil.rate(),
            initial_tension: hung.coil.initial_tension(),
            force: hung.force(),
            stress: hung.coil.stress(hung.force()),
            spring: spring.rate,
            preload: spring.preload,
            give_at_50_g: spring.lag(pull(reach)).to_radians() * reach,
            gaits: gaits.collect(),
        }
    }

    fn print(&self, robot: &Robot, hung: &Hung, out: &mut impl Write) -> io::Result<()> {
        let Self { rate, force, .. } = self;
        writeln!(
            out,
            "spring      {rate:.3} N/mm, initial tension about {:.2} N, {:.1} coils",
            self.initial_tension,
            hung.coil.coils()
        )?;
        writeln!(
            out,
            "hung        {force:.2} N at {} mm, {:.0} N/mm^2 in the wire",
            hung.installed, self.stress
        )?;
        writeln!(
            out,
            "leg         spring = {:.2} (N mm/deg), preload = {:.1} (N mm)",
            self.spring, self.preload
        )?;
        let ground = robot.ground();
        let reach = ground.feet.reach;
        writeln!(
            out,
            "friction    {:.1} N mm at the leg: {} g, {} for the pads, a leg of {reach} mm",
            ground.grip() * reach,
            ground.body.mass,
            ground.friction
        )?;
        writeln!(
            out,
            "by hand     a pad pulled back with 50 g gives {:.1} mm, the servos on\n",
            self.give_at_50_g
        )?;
        writeln!(out, "gait          lag, deg   of rigid legs")?;
        for gait in &self.gaits {
            let share = gait
                .share
                .map_or("-".to_owned(), |share| format!("{:.0} %", 100.0 * share));
            let weak = if gait.share.is_some_and(|share| share < ENOUGH) {
                "   too weak"
            } else {
                ""
            };
            writeln!(out, "{:<12} {:>9.2} {share:>15}{weak}", gait.gait, gait.lag)?;
        }
        if self.stress > BEARS {
            writeln!(
                out,
                "\nThe wire bears about {BEARS:.0} N/mm^2 for good; hang this spring less far."
            )?;
        }
        self.advise(robot, hung, out)
    }

    /// What would do, if this does not.
    fn advise(&self, robot: &Robot, hung: &Hung, out: &mut impl Write) -> io::Result<()> {
        let weak = |gait: &GaitAnswer| gait.share.is_some_and(|share| share < ENOUGH);
        if !self.gaits.iter().any(weak) {
            return writeln!(
                out,
                "\nEvery gait keeps {:.0} % of its way.",
                100.0 * ENOUGH
            );
        }
        writeln!(out, "\nFor every gait to keep {:.0} %:", 100.0 * ENOUGH)?;
        let needed = needed(robot);
        let reach = robot.ground().feet.reach;
        let gives = (pull(reach) / needed).to_radians() * reach;
        writeln!(
            out,
            "- without a stop, {needed:.1} N mm/deg, so that 50 g give under {gives:.1} mm;"
        )?;
        let mut found = false;
        for geometry in [Geometry::Strut, Geometry::Pair, Geometry::Radial] {
            if let Some(other) = enough(robot, hung, geometry, needed) {
                found = true;
                writeln!(
                    out,
                    "- {}: a wire of {} mm in a coil of {} x {} mm, its anchor {:.0} mm from the leg's pivot, {:.1} N at {} mm;",
                    match geometry {
                        Geometry::Strut => "a strut with a stop",
                        Geometry::Pair => "two springs against each other",
                        Geometry::Radial => "one in line with the crank",
                    },
                    other.coil.wire,
                    other.coil.outer,
                    other.coil.length,
                    other.radius,
                    other.force(),
                    other.installed
                )?;
            }
        }
        if !found {
            writeln!(
                out,
                "- no wire up to 1 mm does in this coil: take a shorter or a narrower one;"
            )?;
        }
        writeln!(out, "- or a rigid link in place of the spring.")
    }
}

/// Torque at a leg of so many mm when its pad is pulled back with 50 g, N mm.
fn pull(reach: f64) -> f64 {
    0.05 * lizard_robot::GRAVITY * reach
}

/// The least stiffness (N mm/deg) with which every gait keeps enough.
fn needed(robot: &Robot) -> f64 {
    // A leg's friction over a degree, and halving from there.
    let grip = robot.ground().grip() * robot.ground().feet.reach;
    let (mut low, mut high) = (grip / 10.0, grip * 4.0);
    for _ in 0..7 {
        let middle = (low * high).sqrt();
        let spring = Spring {
            rate: middle,
            preload: 0.0,
        };
        if is_enough(robot, spring) {
            high = middle;
        } else {
            low = middle;
        }
    }
    high
}

/// The thinnest wire and the shortest lever that do in the same coil: by their rate,
/// or by a preload of one and a half times the friction.
fn enough(robot: &Robot, hung: &Hung, geometry: Geometry, needed: f64) -> Option<Hung> {
    const WIRES: [f64; 9] = [0.3, 0.4, 0.5, 0.55, 0.6, 0.7, 0.8, 0.9, 1.0];
    let grip = robot.ground().grip() * robot.ground().feet.reach;
    WIRES.into_iter().find_map(|wire| {
        let coil = Coil { wire, ..hung.coil };
        if coil.outer < 3.0 * wire || coil.coils() < 2.0 {
            return None;
        }
        (10..=25).find_map(|radius| {
            let other = Hung {
                coil,
                geometry,
                radius: f64::from(radius),
                ..*hung
            };
            let spring = other.spring();
            let holds = spring.rate >= needed || spring.preload >= 1.5 * grip;
            (holds && coil.stress(other.force()) < BEARS && other.force() < PULLS).then_some(other)
        })
    })
}
