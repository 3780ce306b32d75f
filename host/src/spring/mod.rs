//! `lizard spring`: does a spring from the shop make this robot walk?

mod geometry;

use std::io::{self, Write};

use lizard_robot::{Coil, Drive, Ground, Kind, Robot, Sprung};
use serde::Serialize;

use crate::json;
use crate::{Failure, RobotFile};
use geometry::{Geometry, Hung};

/// Compute what the legs feel of a tension spring and its anchors
///
/// In the paper a tension spring pulls each leg along; only its size is given, 5.55 x
/// 25.4 mm. The spring decides whether the robot walks: if the friction of a pad is more
/// than the spring holds, the leg lags behind its servo. This command prints both, which
/// gaits keep 90 % of the distance of rigid legs, which spring would do, and what to
/// write into robot.toml.
#[derive(clap::Args, Debug)]
#[command(after_help = "Examples:
  lizard spring --wire 0.6
  lizard spring --wire 0.5 --geometry pair --radius 15
  lizard spring --wire 0.8 --outer 6 --length 20 --installed 24 --geometry radial

What it prints at its end goes into robot.toml.")]
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
    /// Length inside the hooks when mounted, mm [default: from screw to screw of the
    /// robot's struts]
    #[arg(long, value_name = "MM", value_parser = length)]
    installed: Option<f64>,
    /// From the leg's pivot to the anchor on the leg, mm [default: `[parts] anchor` of
    /// robot.toml]
    #[arg(long, value_name = "MM", value_parser = length)]
    radius: Option<f64>,
    /// How the spring is mounted
    #[arg(long, value_enum, default_value_t)]
    geometry: Geometry,
    /// Print one JSON object
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
/// The shear stress that spring wire tolerates permanently, N/mm^2.
const BEARS: f64 = 800.0;

/// The largest force (N) for a printed lever or a servo shaft.
const PULLS: f64 = 15.0;

/// The data of a mounted spring.
#[derive(Debug, Serialize)]
struct Answer {
    /// N/mm
    rate: f64,
    /// N
    initial_tension: f64,
    /// N, mounted, when the leg does not lag
    force: f64,
    /// N/mm^2, likewise
    stress: f64,
    /// As robot.toml has it under `[leg.drive]`: "strut" with `rate` and `force`, or
    /// "spring" with `stiffness`.
    kind: &'static str,
    /// N mm for each degree; null in a strut
    stiffness: Option<f64>,
    /// What the leg withstands before it lags, N mm: the least and the most that the poses
    /// of gaits have
    holds: [f64; 2],
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
/// A spring that cannot be wound, or that is mounted shorter than its free length.
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
    let installed = args.installed.unwrap_or(robot.hung());
    if installed < coil.length {
        let room = match args.installed {
            Some(mm) => format!("--installed is {mm} mm"),
            None => format!("between a strut's screws it has {installed:.1} mm"),
        };
        return Err(Failure::Input(format!(
            "{room}, but without load the spring is {} mm long already",
            coil.length
        )));
    }
    let hung = Hung {
        coil,
        geometry: args.geometry,
        radius: args.radius.unwrap_or(robot.parts().anchor[0]),
        installed,
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

/// The robot's ground with another drive of its legs.
fn on(robot: &Robot, drive: Drive) -> Ground {
    Ground {
        drive,
        ..*robot.ground()
    }
}

/// Whether every gait keeps enough of its way.
fn is_enough(robot: &Robot, drive: Drive) -> bool {
    let ground = on(robot, drive);
    let mut gaits = robot.gaits().iter().filter(|gait| gait.moves());
    gaits.all(|gait| {
        let share = Sprung::of(gait, &ground).and_then(|on| on.share);
        share.is_none_or(|share| share >= ENOUGH)
    })
}

impl Answer {
    fn of(robot: &Robot, hung: &Hung) -> Self {
        let drive = hung.drive(robot);
        let ground = on(robot, drive);
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
            kind: drive.word(),
            stiffness: match drive.kind {
                Kind::Spring(spring) => Some(spring.rate),
                _ => None,
            },
            holds: holds(robot, &drive),
            give_at_50_g: match drive.kind {
                Kind::Spring(spring) => spring.lag(pull(reach)).to_radians() * reach,
                _ => give(robot, hung),
            },
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
            "hung        {force:.2} N at {:.1} mm, {:.0} N/mm^2 in the wire",
            hung.installed, self.stress
        )?;
        match self.stiffness {
            Some(stiffness) => writeln!(
                out,
                "leg         lags a degree for each {stiffness:.2} N mm"
            )?,
            None => writeln!(
                out,
                "leg         follows up to {:.0} N mm, at the best lever of a gait {:.0}",
                self.holds[0], self.holds[1]
            )?,
        }
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
        self.advise(robot, hung, out)?;
        writeln!(
            out,
            "\nIn robot.toml:\n\n[leg.drive]\nkind = \"{}\"",
            self.kind
        )?;
        match self.stiffness {
            Some(stiffness) => writeln!(out, "stiffness = {stiffness:.2}"),
            None => writeln!(out, "force = {force:.2}\nrate = {rate:.3}"),
        }
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
                    "- {}: a wire of {} mm in a coil of {} x {} mm, its anchor {:.0} mm from the leg's pivot, {:.1} N at {:.1} mm;",
                    match geometry {
                        Geometry::Strut => "a strut with a slot",
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

/// Torque at a leg of this many mm when its pad is pulled back with 50 g, N mm.
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
        if is_enough(robot, Drive::spring(middle, 0.0)) {
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
            let drive = other.drive(robot);
            let holds = match drive.kind {
                Kind::Spring(spring) => spring.rate >= needed,
                _ => holds(robot, &drive)[0] >= 1.5 * grip,
            };
            (holds && coil.stress(other.force()) < BEARS && other.force() < PULLS).then_some(other)
        })
    })
}

/// What a leg withstands before it lags, N mm: the least and the most over the poses of all
/// gaits; 0 without a stop.
fn holds(robot: &Robot, drive: &Drive) -> [f64; 2] {
    let Some(strut) = drive.strut() else {
        return [0.0; 2];
    };
    let mut range = [f64::INFINITY, 0.0_f64];
    for gait in robot.gaits() {
        for (_, phase) in gait.frames() {
            let sweeps = robot.sweeps(gait.table_angles(phase));
            for (leg, sweep) in sweeps.into_iter().enumerate() {
                let preload = strut.preload(leg, sweep);
                range = [range[0].min(preload), range[1].max(preload)];
            }
        }
    }
    range
}

/// How far a pad gives at neutral that is pulled with 50 g the way in which its strut
/// grows, mm.
fn give(robot: &Robot, hung: &Hung) -> f64 {
    let (strut, reach) = (hung.strut(robot), robot.ground().feet.reach);
    let beyond = pull(reach) - strut.preload(0, 0.0);
    let rate = strut.rate * strut.lever(0, 0.0) * strut.lever(0, 0.0);
    let (most, _) = strut.end(0, 0.0);
    let lag = match beyond > 0.0 {
        true => (beyond / rate).min(most.to_radians()),
        false => 0.0,
    };
    lag * reach
}
