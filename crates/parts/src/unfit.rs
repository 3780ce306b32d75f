//! Why a robot cannot be built.

use lizard_kinematics::Vector;

use crate::bodies::assembly::Assembly;
use crate::bodies::sliders::slider_range;
use crate::layers::body::{Body, Kind, Prism};
use crate::layers::shape::Shape;
use crate::order::reach::Blocked;
use crate::order::steps::steps;
use crate::proof::Clash;

/// What does not fit, in the sentence that the user sees.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Unfit {
    /// Two parts would be in one place, or nearly.
    #[error("{0}; other links, or other measures under [parts] in robot.toml, may keep them apart")]
    Clash(#[from] Clash),
    /// A bar is too narrow for the head of its screw.
    #[error(
        "parts.bar is {bar} mm, but the head of a screw and a wall on each side need {least:.1} mm"
    )]
    Narrow {
        /// Its width, mm.
        bar: f64,
        /// What it needs, mm.
        least: f64,
    },
    /// The sunk nut would come out of the crank.
    #[error(
        "the nut of a leg's anchor does not fit into its crank with a screw from the shop; raise parts.thickness or the servo's horn"
    )]
    Nut,
    /// The leg's strut is shorter than its spring.
    #[error(
        "leg strut {leg} is {strut:.1} mm from screw to screw, but its spring is {spring:.1} mm long inside its hooks without load and must be pulled; parts.pivot sets the one, parts.spring.length the other; [leg.drive] kind = \"rigid\" needs no spring"
    )]
    Spring {
        /// LF, RF, RH, LH.
        leg: &'static str,
        /// mm
        strut: f64,
        /// mm
        spring: f64,
    },
    /// The foot's post would be too short.
    #[error(
        "parts.height is {height} mm; the feet need {least:.1} mm to keep the servos off the floor"
    )]
    Low {
        /// mm
        height: f64,
        /// mm
        least: f64,
    },
    /// A slider whose sleeve would be too short.
    #[error(
        "the {side} slider is {shortest:.1} mm at its shortest and {longest:.1} mm at its longest; a rod that stays in its sleeve does not fit between: raise limits.stroke_min or lower limits.stroke_max"
    )]
    Slider {
        /// left or right
        side: &'static str,
        /// mm
        shortest: f64,
        /// mm
        longest: f64,
    },
    /// Two parts that move together would be in one place.
    #[error(
        "{first} and {second}, which move together, overlap by {mm:.2} mm; other links, or other measures under [parts] in robot.toml, may keep them apart"
    )]
    Inside {
        /// One body.
        first: String,
        /// The other.
        second: String,
        /// mm
        mm: f64,
    },
    /// A screw that cannot be reached.
    #[error(
        "{0}, at every pose; other links, or other measures under [parts] in robot.toml, may make room"
    )]
    Blocked(#[from] Blocked),
    /// The layers of a part do not make a body.
    #[error(
        "the layers of {0} do not make one body; a measure under [parts] in robot.toml is too small or too large for it"
    )]
    Surface(String),
    /// Screws that no shop has.
    #[error(
        "{0} would have to be {1:.1} mm long, which no shop has; lower parts.thickness or parts.plate"
    )]
    Screw(String, f64),
}

/// Air between servos and floor, mm.
const OFF_FLOOR: f64 = 8.0;
/// The shortest sleeve that guides a rod, mm.
const SLEEVE: f64 = 25.0;

impl Assembly {
    /// Whether the robot can be built: measures go together, every screw can be reached,
    /// and no two parts meet at any pose that the guard accepts, which is proved and takes
    /// seconds.
    ///
    /// # Errors
    /// The first measure that does not fit, else the two parts that overlap most, else a
    /// screw.
    pub fn fits(&self) -> Result<(), Unfit> {
        self.measures_fit()?;
        self.prove(|_, _| ()).judge()?;
        self.asides(&steps(self.robot().drive().strut().is_some()))?;
        Ok(())
    }

    /// Whether measures go together.
    ///
    /// # Errors
    /// The first that does not fit.
    pub fn measures_fit(&self) -> Result<(), Unfit> {
        let (parts, stack) = (self.robot().parts(), self.stack());
        let least = parts.screw.head + 2.0 * parts.fit + 1.2;
        if parts.bar < least {
            let bar = parts.bar;
            return Err(Unfit::Narrow { bar, least });
        }
        if !stack.holds_nut(parts) {
            return Err(Unfit::Nut);
        }
        let least = OFF_FLOOR - stack.servo;
        if parts.height < least {
            let height = parts.height;
            return Err(Unfit::Low { height, least });
        }
        let legs = lizard_robot::servo::LEGS.iter().zip(&self.layout().legs);
        for (leg, layout) in legs.filter(|_| self.robot().drive().strut().is_some()) {
            if self.robot().hung() <= parts.spring.length {
                return Err(Unfit::Spring {
                    leg,
                    strut: layout.strut_length,
                    spring: parts.spring.length,
                });
            }
        }
        for side in lizard_kinematics::Side::ALL {
            let range = slider_range(self.robot(), side);
            let lengths = crate::SliderLengths::new(side, range);
            if lengths.sleeve < SLEEVE {
                return Err(Unfit::Slider {
                    side: side.name(),
                    shortest: range[0],
                    longest: range[1],
                });
            }
        }
        for body in self.bodies() {
            if let Kind::Screw(length) | Kind::HexScrew(length) = body.kind
                && !crate::layers::stack::is_sold(length)
            {
                return Err(Unfit::Screw(body.name.clone(), length));
            }
            if body.prisms.iter().any(|prism| prism.z[1] <= prism.z[0]) {
                return Err(Unfit::Surface(body.name.clone()));
            }
        }
        self.none_is_in_another()
    }

    /// Whether of the bodies that move together none is in another one's place.
    fn none_is_in_another(&self) -> Result<(), Unfit> {
        /// What is pressed in may touch, mm.
        const TOUCH: f64 = 0.02;
        let bodies = self.bodies();
        for (i, a) in bodies.iter().enumerate() {
            for b in bodies[i + 1..].iter().filter(|b| b.mount == a.mount) {
                let air = air(self.outside_threads(a), self.outside_threads(b));
                if air < -TOUCH {
                    return Err(Unfit::Inside {
                        first: a.name.clone(),
                        second: b.name.clone(),
                        mm: -air,
                    });
                }
            }
        }
        Ok(())
    }

    /// The layers of a body, but of a screw without a nut only its head: what it is
    /// turned into has its thread.
    fn outside_threads<'a>(&self, body: &'a Body) -> &'a [Prism] {
        let nut = body.name.replacen("screw", "nut", 1);
        match (body.kind, &body.prisms[..]) {
            (Kind::Screw(_) | Kind::HornScrew(_), [low, high]) if self.body(&nut).is_none() => {
                let head_above = high.add[0].width() > low.add[0].width();
                &body.prisms[usize::from(head_above)..][..1]
            }
            (_, all) => all,
        }
    }
}

/// How far some layers are from others at the heights that they share, or in their
/// holes, mm; below 0 they overlap.
fn air(a: &[Prism], b: &[Prism]) -> f64 {
    let still = Vector::default();
    let mut least = f64::INFINITY;
    for p in a {
        for q in b {
            if p.z[0] > q.z[1] - 1e-6 || q.z[0] > p.z[1] - 1e-6 {
                continue;
            }
            for first in &p.add {
                for second in &q.add {
                    let beside = first.distance(second);
                    let within = |shape: &Shape, holes: &[Shape]| {
                        let air = holes.iter().map(|hole| shape.within(hole, still));
                        air.fold(f64::NEG_INFINITY, f64::max)
                    };
                    let air = beside
                        .max(within(first, &q.cut))
                        .max(within(second, &p.cut));
                    least = least.min(air);
                }
            }
        }
    }
    least
}
