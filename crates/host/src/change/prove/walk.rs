//! Rows and columns of positions, and the two decisions at each pair.

use std::sync::OnceLock;

use lizard_core::guard::five_bar::EndMargins;
use lizard_core::guard::trig::Direction;
use lizard_core::numbers::cells::Cells;
use lizard_core::numbers::part;
use lizard_core::numbers::units::ONE_Q15;
use lizard_kinematics::{AssemblyMode, End, FiveBar, Lanes, Side, Slider, Vector};
use lizard_robot::{CellMaps, CoreRobot, Robot, servo};
use rayon::prelude::*;

use super::positions::Positions;
use super::tally::{MARGIN_BAND, STEPS_BAND, Tally, margin_band};
use super::{Finding, Share};

/// Columns that floating point takes at once.
const LANES: usize = 8;

/// Pieces that the rows of an end or a side are cut into.
const CUTS: usize = 64;
/// Pieces of the whole walk: of both ends and of both sides.
pub const PIECES: usize = 4 * CUTS;

/// The walk of a robot's pairs with a guard: what all of its pieces need is computed once.
pub struct Walk<'a> {
    robot: &'a Robot,
    guard: &'a CoreRobot,
    share: Share,
    maps: CellMaps,
    /// Of each servo, as soon as a piece needs them.
    positions: [OnceLock<Positions>; 4],
}

impl<'a> Walk<'a> {
    /// Through a share of the pairs.
    pub fn new(robot: &'a Robot, guard: &'a CoreRobot, share: Share) -> Self {
        Self {
            robot,
            guard,
            share,
            maps: robot.cell_maps(),
            positions: Default::default(),
        }
    }

    fn positions(&self, servo: usize) -> &Positions {
        self.positions[servo].get_or_init(|| Positions::of(self.guard, servo))
    }

    /// One piece by its place, below [`PIECES`].
    pub fn piece(&self, place: usize, progress: &(dyn Fn(u64) + Sync)) -> Tally {
        let (whole, cut) = (place / CUTS, place % CUTS);
        let of = |servos: [usize; 2]| servos.map(|servo| self.positions(servo));
        if let Some(end) = End::ALL.get(whole) {
            let walk = EndWalk::new(self.robot, self.guard, &self.maps, *end);
            walk.walk(of(end.servos()), self.share, cut, progress)
        } else {
            let side = Side::ALL[whole - End::ALL.len()];
            let walk = SideWalk::new(self.robot, self.guard, &self.maps, side);
            walk.walk(of(side.servos()), self.share, cut, progress)
        }
    }
}

/// The findings for every end, side and leg of a robot, from all pieces in their order.
pub fn findings(robot: &Robot, guard: &CoreRobot, pieces: Vec<Tally>) -> Vec<Finding> {
    let mut pieces = pieces.into_iter();
    let mut of_one = || {
        pieces
            .by_ref()
            .take(CUTS)
            .fold(Tally::default(), Tally::and)
    };
    let mut findings = Vec::new();
    for end in End::ALL {
        findings.push(Finding {
            part: end.name().to_string(),
            servos: names(end.servos()),
            tally: of_one(),
        });
    }
    for side in Side::ALL {
        findings.push(Finding {
            part: format!("{side} side"),
            servos: names(side.servos()),
            tally: of_one(),
        });
    }
    for (servo, leg_name) in servo::LEGS.iter().enumerate() {
        findings.push(Finding {
            part: format!("leg {leg_name}"),
            servos: vec![servo::NAMES[servo]],
            tally: leg(robot, guard, &Positions::of(guard, servo)),
        });
    }
    findings
}

/// The widest band of the robot's ends: see [`margin_band`].
pub fn widest_band(robot: &Robot) -> f64 {
    End::ALL
        .map(|end| bands(robot, end)[0])
        .into_iter()
        .fold(MARGIN_BAND, f64::max)
}

/// The bands of an end in which decisions may differ: a sine around the limit of a margin, and
/// mm around the crossing of its crank tips.
fn bands(robot: &Robot, end: End) -> [f64; 2] {
    let step = f64::from(1u32 << robot.content().ends[end as usize].scale.bits).recip();
    let band = margin_band(&robot.lizard().end(end), robot.limits().type2, step);
    [band, STEPS_BAND * step]
}

/// The core's name of an end.
fn part(end: End) -> part::End {
    match end {
        End::Head => part::End::Head,
        End::Tail => part::End::Tail,
    }
}

/// The number of rows to check.
pub fn rows(guard: &CoreRobot) -> u64 {
    let positions = |servo: usize| {
        let calibration = guard.calibration()[servo];
        (i32::from(calibration.max.0) - i32::from(calibration.min.0) + 1) as u64
    };
    let first = End::ALL
        .map(|end| end.servos()[0])
        .into_iter()
        .chain(Side::ALL.map(|side| side.servos()[0]));
    first.map(positions).sum()
}

fn names(servos: [usize; 2]) -> Vec<&'static str> {
    servos.map(|servo| servo::NAMES[servo]).to_vec()
}

/// The columns of a row that belong to a share.
fn columns(share: Share, row: usize, count: usize) -> impl Iterator<Item = usize> {
    let first = (row + share.offset as usize) % share.one_in as usize;
    (first..count).step_by(share.one_in as usize)
}

/// Walks the rows of a piece on all cores.
fn rows_of(
    first: &Positions,
    cut: usize,
    progress: &(dyn Fn(u64) + Sync),
    row: impl Fn(usize) -> Tally + Sync,
) -> Tally {
    let rows = first.fixed.len();
    (rows * cut / CUTS..rows * (cut + 1) / CUTS)
        .into_par_iter()
        .map(|index| {
            let tally = row(index);
            progress(1);
            tally
        })
        .reduce(Tally::default, Tally::and)
}

/// The columns of a row, eight at a time; the last ones are repeated.
fn eight_by_eight(
    mut columns: impl Iterator<Item = usize>,
    mut take: impl FnMut([usize; LANES], usize),
) {
    loop {
        let mut eight = [0; LANES];
        let mut count = 0;
        for column in columns.by_ref().take(LANES) {
            eight[count..].fill(column);
            count += 1;
        }
        if count == 0 {
            return;
        }
        take(eight, count);
    }
}

fn lanes(of: &[Vector], columns: [usize; LANES]) -> Vector<Lanes<LANES>> {
    Vector::new(
        Lanes(columns.map(|column| of[column].x)),
        Lanes(columns.map(|column| of[column].y)),
    )
}

fn splat(vector: Vector) -> Vector<Lanes<LANES>> {
    Vector::new(Lanes([vector.x; LANES]), Lanes([vector.y; LANES]))
}

/// A margin of the firmware as a sine.
fn sine(q15: i16) -> f64 {
    f64::from(q15) / f64::from(ONE_Q15)
}

/// The pairs of an end.
struct EndWalk<'a> {
    fixed: lizard_core::guard::five_bar::FiveBar<'a>,
    exact: FiveBar,
    /// Type-2 and type-1, as robot.toml and as the firmware has them.
    limits: [f64; 2],
    fixed_limits: [i16; 2],
    /// Of the legs, as the firmware has it.
    fixed_leg: i16,
    end: End,
    cells: Cells<'a>,
    margin_band: f64,
    crossing_band: f64,
}

impl<'a> EndWalk<'a> {
    fn new(robot: &Robot, guard: &'a CoreRobot, maps: &'a CellMaps, end: End) -> Self {
        let limits = guard.limits();
        let [margin_band, crossing_band] = bands(robot, end);
        let map = match end {
            End::Head => &maps.head,
            End::Tail => &maps.tail,
        };
        Self {
            fixed: guard.end(part(end)),
            exact: robot.lizard().end(end),
            limits: [robot.limits().type2, robot.limits().type1],
            fixed_limits: [limits.type2.0, limits.type1.0],
            fixed_leg: limits.leg.0,
            end,
            cells: map.cells(),
            margin_band,
            crossing_band,
        }
    }

    fn walk(
        &self,
        [left, right]: [&Positions; 2],
        share: Share,
        cut: usize,
        progress: &(dyn Fn(u64) + Sync),
    ) -> Tally {
        rows_of(left, cut, progress, |row| {
            let mut tally = Tally::default();
            let crank = splat(left.exact[row]);
            eight_by_eight(columns(share, row, right.fixed.len()), |eight, count| {
                let other = lanes(&right.exact, eight);
                let pose = self.exact.shape(AssemblyMode::Ahead, crank, other);
                let closes = self.exact.closes(&pose);
                let Lanes(type2) = pose.type2;
                let Lanes(type1_left) = pose.type1_left();
                let Lanes(type1_right) = pose.type1_right();
                let Lanes(across) = pose.gap.x;
                for lane in 0..count {
                    let column = eight[lane];
                    let truth = EndTruth {
                        closes: closes[lane],
                        type2: type2[lane],
                        type1: [type1_left[lane], type1_right[lane]],
                        across: across[lane],
                    };
                    let margins = self.fixed.margins(&left.fixed[row], &right.fixed[column]);
                    let place = || {
                        format!(
                            "{} at {:.4} and {:.4} deg",
                            self.end.name(),
                            left.degrees[row],
                            right.degrees[column]
                        )
                    };
                    self.compare(&mut tally, margins, &truth, place);
                    let [sweep, other] = [left.sweep(row), right.sweep(column)];
                    // Their rows are A1 and A3, their columns A2 and A4.
                    let held = match self.end {
                        End::Head => self.cells.hold(sweep, other),
                        End::Tail => self.cells.hold(other, sweep),
                    };
                    if held {
                        let legs = [left.fixed[row], right.fixed[column]];
                        let accepted = self.accepts(margins)
                            && legs.iter().all(|leg| leg.sin >= self.fixed_leg);
                        tally.certify(accepted, place);
                    }
                }
            });
            tally
        })
    }

    /// True if the guard accepts an end with these margins.
    #[inline(always)]
    fn accepts(&self, margins: EndMargins) -> bool {
        let [type2, type1] = self.fixed_limits;
        margins.type2.0 >= type2 && margins.type1_left.0 >= type1 && margins.type1_right.0 >= type1
    }

    #[inline(always)]
    fn compare(
        &self,
        tally: &mut Tally,
        margins: EndMargins,
        truth: &EndTruth,
        place: impl Fn() -> String,
    ) {
        tally.pairs += 1;
        let fixed = self.accepts(margins);
        let EndMargins {
            type2,
            type1_left,
            type1_right,
        } = margins;
        // Where the couplers fold, no other margin matters.
        if truth.closes && truth.type2 > self.limits[0] - self.margin_band {
            Tally::raise(&mut tally.type2, (sine(type2.0).abs() - truth.type2).abs());
            for (fixed, exact) in [type1_left, type1_right].into_iter().zip(truth.type1) {
                Tally::raise(&mut tally.type1, (sine(fixed.0) - exact).abs());
            }
        }
        let (clear, crossed) = truth.clear_by(self.limits);
        let exact = clear >= 0.0 && crossed > 0.0;
        if fixed != exact {
            // Of what decides, how far it is beyond its limit.
            let by_crossing = crossed / self.crossing_band < clear / self.margin_band;
            let (by, band) = if by_crossing {
                (crossed.abs(), self.crossing_band)
            } else {
                (clear.abs(), self.margin_band)
            };
            tally.differ(by_crossing, by, band, || {
                format!(
                    "{}: the guard says {}, floating point {}: margins {:.5} {:.5} {:.5}, for {:.5} {:.5} {:.5}, crank tips {:+.4} mm apart across",
                    place(),
                    if fixed { "safe" } else { "unsafe" },
                    if exact { "safe" } else { "unsafe" },
                    sine(type2.0),
                    sine(type1_left.0),
                    sine(type1_right.0),
                    truth.type2,
                    truth.type1[0],
                    truth.type1[1],
                    truth.across,
                )
            });
        }
    }
}

/// An end at a pair of angles, in floating point.
struct EndTruth {
    closes: bool,
    type2: f64,
    type1: [f64; 2],
    /// From the left crank tip to the right one, mm, across the end.
    across: f64,
}

impl EndTruth {
    /// By how much the least margin is above its limit, a sine; and by how much the
    /// crank tips are uncrossed, mm.
    #[inline(always)]
    fn clear_by(&self, [least2, least1]: [f64; 2]) -> (f64, f64) {
        if !self.closes {
            return (-least2, self.across);
        }
        let type1 = self.type1[0].min(self.type1[1]) - least1;
        ((self.type2 - least2).min(type1), self.across)
    }
}

/// The pairs of a side.
struct SideWalk<'a> {
    side: Side,
    cells: Cells<'a>,
    fixed: lizard_core::numbers::slider::Slider,
    exact: Slider,
    stroke: [f64; 2],
    steps_per_mm: f64,
}

impl<'a> SideWalk<'a> {
    fn new(robot: &Robot, guard: &CoreRobot, maps: &'a CellMaps, side: Side) -> Self {
        let (fixed, map) = match side {
            Side::Left => (guard.side(part::Side::Left), &maps.left),
            Side::Right => (guard.side(part::Side::Right).mirrored(), &maps.right),
        };
        Self {
            side,
            cells: map.cells(),
            fixed,
            exact: robot.lizard().side(side),
            stroke: [robot.limits().stroke_min, robot.limits().stroke_max],
            steps_per_mm: f64::from(1u32 << fixed.scale.bits),
        }
    }

    fn walk(
        &self,
        [front, rear]: [&Positions; 2],
        share: Share,
        cut: usize,
        progress: &(dyn Fn(u64) + Sync),
    ) -> Tally {
        let turned = |direction: Direction| match self.side {
            Side::Left => direction,
            Side::Right => direction.mirrored(),
        };
        let band = STEPS_BAND / self.steps_per_mm;
        rows_of(front, cut, progress, |row| {
            let mut tally = Tally::default();
            let crank = turned(front.fixed[row]);
            let front_arm = splat(self.side.front_arm(front.exact[row]));
            eight_by_eight(columns(share, row, rear.fixed.len()), |eight, count| {
                // Positions are in the frame of their end, arms in the chassis'.
                let crank_rear = End::Tail.mirror(lanes(&rear.exact, eight));
                let pose = self.exact.shape(self.side.rear_arm(crank_rear), front_arm);
                let (Lanes(d), Lanes(s)) = (pose.d, pose.s);
                for lane in 0..count {
                    let column = eight[lane];
                    tally.pairs += 1;
                    let length_sq = self.fixed.length_sq(&crank, &turned(rear.fixed[column]));
                    let length = f64::from(length_sq).sqrt() / self.steps_per_mm;
                    Tally::raise(&mut tally.travel, (length - d[lane]).abs());
                    let fixed = self.fixed.allows(length_sq);
                    if self.cells.hold(front.sweep(row), rear.sweep(column)) {
                        tally.certify(fixed, || {
                            format!(
                                "{} side at {:.4} and {:.4} deg",
                                self.side, front.degrees[row], rear.degrees[column]
                            )
                        });
                    }
                    let [min, max] = self.stroke;
                    let clear = (s[lane] - min).min(max - s[lane]);
                    if fixed != (clear >= 0.0) {
                        tally.differ(true, clear.abs(), band, || {
                            format!(
                                "at {:.4} and {:.4} deg the slider is {length:.5} mm long by the guard, {:.5} by floating point",
                                front.degrees[row], rear.degrees[column], d[lane]
                            )
                        });
                    }
                }
            });
            tally
        })
    }
}

/// The positions of one leg.
fn leg(robot: &Robot, guard: &CoreRobot, positions: &Positions) -> Tally {
    let mut tally = Tally::default();
    let least = guard.limits().leg.0;
    for (position, (fixed, exact)) in positions.fixed.iter().zip(&positions.exact).enumerate() {
        tally.pairs += 1;
        Tally::raise(&mut tally.leg, (sine(fixed.sin) - exact.y).abs());
        let clear = exact.y - robot.limits().leg;
        if (fixed.sin >= least) != (clear >= 0.0) {
            tally.differ(false, clear.abs(), MARGIN_BAND, || {
                format!("at {:.4} deg", positions.degrees[position])
            });
        }
    }
    tally
}
