//! Servo angles over time, and below them which foot pushes and which returns.

use lizard_robot::Robot;
use lizard_robot::servo::NAMES;
use svg::Document;
use svg::node::element::Group;

use super::analysis::Instant;
use super::footfall::{Phase, Stretch, stretches};
use super::script::Script;
use crate::draw::ink::{Anchor, DARK, GREY, GRID, PANEL, SERVO, curve, line, rectangle, text};

const WIDTH: f64 = 1280.0;
const LEFT: f64 = 200.0;
const RIGHT: f64 = 36.0;
const COMMANDS: f64 = 88.0;
const STRIPS: f64 = 132.0;
const STRIP: f64 = 104.0;
const STRIP_GAP: f64 = 14.0;
const FEET: f64 = STRIPS + 4.0 * (STRIP + STRIP_GAP) + 34.0;
const FOOT: f64 = 28.0;
const FOOT_GAP: f64 = 8.0;
const AXIS: f64 = FEET + 4.0 * (FOOT + FOOT_GAP) + 4.0;
const HEIGHT: f64 = AXIS + 96.0;

/// Where each servo's leg is.
const PLACES: [&str; 4] = ["front left", "front right", "back right", "back left"];

/// The picture as SVG text.
#[must_use]
pub fn draw(robot: &Robot, instants: &[Instant], script: &Script) -> String {
    let chart = Chart {
        robot,
        instants,
        seconds: (script.end_ms as f64 / 1000.0).max(0.1),
    };
    let mut group = Group::new();
    group = group.add(rectangle((0.0, 0.0), (WIDTH, HEIGHT), "white"));
    group = chart.title(group);
    group = chart.commands(group, script);
    for servo in 0..4 {
        group = chart.strip(group, servo);
        group = chart.feet(group, servo);
    }
    group = chart.marks(group, script);
    group = chart.axis(group);
    Document::new()
        .set("viewBox", (0.0, 0.0, WIDTH, HEIGHT))
        .set("width", WIDTH)
        .set("height", HEIGHT)
        .add(group)
        .to_string()
}

struct Chart<'a> {
    robot: &'a Robot,
    instants: &'a [Instant],
    seconds: f64,
}

impl Chart<'_> {
    fn x(&self, seconds: f64) -> f64 {
        LEFT + (WIDTH - LEFT - RIGHT) * seconds / self.seconds
    }

    fn title(&self, group: Group) -> Group {
        let title = "Servo angles and footfalls, measured on the simulated UNO";
        let note = "degrees in the chassis frame, read back from every pulse; \
                    dashed: the neutral angle";
        group
            .add(text(title, (LEFT, 40.0), 24.0, DARK, Anchor::Start).set("font-weight", "bold"))
            .add(text(note, (LEFT, 66.0), 15.0, GREY, Anchor::Start))
    }

    /// The band that says which command is in effect.
    fn commands(&self, mut group: Group, script: &Script) -> Group {
        for (n, (from, to, command)) in spans(script, self.seconds).into_iter().enumerate() {
            let (x, end) = (self.x(from), self.x(to));
            let fill = if n % 2 == 0 { "#e6e6e6" } else { "#d2d2d2" };
            group = group.add(rectangle((x, COMMANDS), (end - x, 26.0), fill));
            // About 7.5 px a letter: leave out what would run over.
            if command.len() as f64 * 7.5 < end - x {
                let at = ((x + end) / 2.0, COMMANDS + 18.0);
                group = group.add(text(command, at, 15.0, DARK, Anchor::Middle));
            }
        }
        group.add(text(
            "command",
            (LEFT - 12.0, COMMANDS + 18.0),
            15.0,
            GREY,
            Anchor::End,
        ))
    }

    /// A line down the whole picture where a command is given.
    fn marks(&self, mut group: Group, script: &Script) -> Group {
        for (from, _, _) in spans(script, self.seconds).into_iter().skip(1) {
            let x = self.x(from);
            let mark = line((x, COMMANDS), (x, AXIS), GREY, 1.0);
            group = group.add(mark.set("stroke-dasharray", "2 4"));
        }
        group
    }

    /// Half the height of every strip in degrees, the same for all so that
    /// slopes compare.
    fn reach(&self) -> f64 {
        let sweeps = self.instants.iter().filter_map(|at| at.sweeps).flatten();
        (sweeps.fold(20.0, |most: f64, sweep| most.max(sweep.abs())) / 10.0).ceil() * 10.0 + 5.0
    }

    fn strip(&self, mut group: Group, servo: usize) -> Group {
        let top = STRIPS + servo as f64 * (STRIP + STRIP_GAP);
        let reach = self.reach();
        let neutral = self.robot.servos[servo].neutral;
        let y = |angle: f64| top + STRIP / 2.0 * (1.0 - (angle - neutral) / reach);
        let (begin, end) = (self.x(0.0), self.x(self.seconds));
        let name = format!("{} {}", NAMES[servo], PLACES[servo]);
        let pin = format!("D{}", self.robot.servos[servo].pin);
        group = group
            .add(rectangle((begin, top), (end - begin, STRIP), PANEL))
            .add(
                text(
                    &name,
                    (14.0, top + STRIP / 2.0 - 2.0),
                    17.0,
                    SERVO[servo],
                    Anchor::Start,
                )
                .set("font-weight", "bold"),
            )
            .add(text(
                &pin,
                (14.0, top + STRIP / 2.0 + 18.0),
                14.0,
                GREY,
                Anchor::Start,
            ));
        let step = if reach > 50.0 { 40.0 } else { 20.0 };
        let first = -(reach / step).floor() as i32;
        for n in first..=-first {
            let angle = neutral + f64::from(n) * step;
            let rule = line((begin, y(angle)), (end, y(angle)), GRID, 1.0);
            group = group.add(if n == 0 {
                rule.set("stroke", "#999999").set("stroke-dasharray", "6 4")
            } else {
                rule
            });
            let label = format!("{angle:.0}°");
            let at = (LEFT - 8.0, y(angle) + 4.5);
            group = group.add(text(&label, at, 13.0, GREY, Anchor::End));
        }
        for run in self.runs(servo) {
            let points: Vec<(f64, f64)> = run
                .iter()
                .map(|(seconds, angle)| (self.x(*seconds), y(*angle)))
                .collect();
            group = group.add(curve(&points, SERVO[servo], 2.2));
        }
        group
    }

    /// The unbroken stretches of a servo's angle: (seconds, degrees).
    fn runs(&self, servo: usize) -> Vec<Vec<(f64, f64)>> {
        let mut runs = vec![Vec::new()];
        for at in self.instants {
            match (at.angles, runs.last_mut()) {
                (Some(angles), Some(run)) => run.push((at.seconds, angles[servo])),
                _ => runs.push(Vec::new()),
            }
        }
        runs.retain(|run| !run.is_empty());
        runs
    }

    fn feet(&self, mut group: Group, servo: usize) -> Group {
        let top = FEET + servo as f64 * (FOOT + FOOT_GAP);
        let (begin, end) = (self.x(0.0), self.x(self.seconds));
        if servo == 0 {
            let at = (14.0, FEET - 12.0);
            group = group
                .add(text("Footfalls", at, 17.0, DARK, Anchor::Start).set("font-weight", "bold"));
            group = self.legend(group);
        }
        group = group
            .add(rectangle((begin, top), (end - begin, FOOT), PANEL))
            .add(text(
                PLACES[servo],
                (LEFT - 12.0, top + FOOT / 2.0 + 5.0),
                15.0,
                SERVO[servo],
                Anchor::End,
            ));
        for Stretch { phase, from, to } in stretches(self.instants, servo) {
            let (x, width) = (self.x(from), self.x(to) - self.x(from));
            group = group.add(foot(phase, SERVO[servo], (x, top), (width, FOOT)));
        }
        group
    }

    fn legend(&self, mut group: Group) -> Group {
        let entries = [
            (Phase::Stance, "moves back: stance of a forward gait"),
            (Phase::Still, "stands still"),
            (Phase::Swing, "moves forward: return"),
        ];
        let mut x = LEFT;
        for (phase, words) in entries {
            group = group
                .add(foot(phase, "#444444", (x, FEET - 25.0), (30.0, 15.0)))
                .add(text(
                    words,
                    (x + 38.0, FEET - 12.5),
                    14.0,
                    GREY,
                    Anchor::Start,
                ));
            x += 60.0 + 7.2 * words.len() as f64;
        }
        group
    }

    fn axis(&self, mut group: Group) -> Group {
        let steps = [
            0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 60.0, 120.0, 300.0, 600.0,
        ];
        let step = steps
            .into_iter()
            .find(|step| self.seconds / step <= 15.0)
            .unwrap_or(3600.0);
        group = group.add(line(
            (self.x(0.0), AXIS),
            (self.x(self.seconds), AXIS),
            DARK,
            1.2,
        ));
        for n in 0..=(self.seconds / step + 1e-9) as u32 {
            let seconds = f64::from(n) * step;
            let x = self.x(seconds);
            let label = if step < 1.0 {
                format!("{seconds:.1}")
            } else {
                format!("{seconds:.0}")
            };
            group = group
                .add(line((x, AXIS), (x, AXIS + 7.0), DARK, 1.2))
                .add(text(&label, (x, AXIS + 25.0), 14.0, DARK, Anchor::Middle));
        }
        let middle = (self.x(0.0) + self.x(self.seconds)) / 2.0;
        let words = "time since power-on (s)";
        group.add(text(
            words,
            (middle, AXIS + 50.0),
            15.0,
            DARK,
            Anchor::Middle,
        ))
    }
}

/// A stretch of a footfall row: full for stance, pale for still, empty for
/// swing, so that it reads without colour.
fn foot(
    phase: Phase,
    colour: &str,
    at: (f64, f64),
    size: (f64, f64),
) -> svg::node::element::Rectangle {
    match phase {
        Phase::Stance => rectangle(at, size, colour),
        Phase::Still => rectangle(at, size, colour).set("fill-opacity", 0.22),
        Phase::Swing => {
            let inner = (
                (at.0 + 0.7, at.1 + 0.7),
                ((size.0 - 1.4).max(0.2), size.1 - 1.4),
            );
            rectangle(inner.0, inner.1, "white")
                .set("stroke", colour.to_owned())
                .set("stroke-width", 1.4)
        }
    }
}

/// The commands as stretches of time; questions change nothing and are left
/// out.
fn spans(script: &Script, end: f64) -> Vec<(f64, f64, &str)> {
    let quiet = |command: &str| ["status", "help", "?"].contains(&command);
    let steps = script.steps.iter().filter(|step| !quiet(&step.command));
    let mut starts: Vec<(f64, &str)> = vec![(0.0, "boot, stand")];
    starts.extend(steps.map(|step| (step.ms as f64 / 1000.0, step.command.as_str())));
    let end_of = |n: usize| starts.get(n + 1).map_or(end, |next| next.0);
    (0..starts.len())
        .map(|n| (starts[n].0, end_of(n), starts[n].1))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::script::Step;

    #[test]
    fn each_unbroken_stretch_of_each_servo_is_one_curve() {
        let robot = Robot::parse(include_str!("../../../robot.toml")).expect("robot.toml is right");
        let neutral: [f64; 4] = robot.neutral().into();
        let instants: Vec<Instant> = (0..400)
            .map(|n| Instant {
                seconds: f64::from(n) / 50.0,
                angles: (n != 100 && n < 350).then_some(neutral),
                sweeps: (n != 100 && n < 350).then_some([0.0; 4]),
            })
            .collect();
        let step = |ms, command: &str| Step {
            ms,
            command: command.into(),
        };
        let steps = vec![step(1000, "walk"), step(2000, "status"), step(7000, "rest")];
        let script = Script {
            steps,
            end_ms: 8000,
        };
        let picture = draw(&robot, &instants, &script);
        assert_eq!(picture.matches("<polyline").count(), 8);
        assert!(picture.contains("walk") && !picture.contains("status"));
    }
}
