//! The heights of the parts, in one table that all other modules use.
//!
//! z is up; 0 is the top of the chassis plate. All parts are flat and all joint axes are vertical, so parts do not
//! collide if those that overlap in plan view have different heights. From below: the floor, the foot's leaf, the
//! plate and the legs' couplers beside it, the legs' cranks, the struts, the servos' links, the couplers of head and
//! tail with the sliders, the deck.

use lizard_robot::Parts;

/// Heights of a layer's bottom and top, mm above the chassis plate's top.
pub type Span = [f64; 2];

/// Orders two heights, lower before upper.
pub(crate) fn order_heights(a: f64, b: f64) -> Span {
    [a.min(b), a.max(b)]
}

/// Common screw lengths, mm. ISO 7380 and ISO 4017 define more lengths, but few shops stock the others.
pub const SCREW_LENGTHS: [f64; 6] = [6.0, 8.0, 10.0, 12.0, 16.0, 20.0];

/// Common standoff lengths, mm.
const STANDOFF_LENGTHS: [f64; 9] = [10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 45.0, 50.0];

/// Gap between a screw's head or nut and the part that turns under it, mm.
pub const HEAD_CLEARANCE: f64 = 0.2;
/// Height of a hexagonal head, mm (ISO 4017).
pub const HEX_HEAD_HEIGHT: f64 = 2.0;
/// Height of the seat under a servo's flange, mm; the seat lifts the horn above the strut.
const SEAT_HEIGHT: f64 = 2.6;
/// Height of a leg's bearing on the plate, mm. The foot is six times this height away from the bearing, so play
/// of 0.2 mm in the bearing moves the foot by 1.2 mm.
const BEARING_HEIGHT: f64 = 8.5;
/// Distance from the underside of a leg's crank up to the tip of its anchor's screw, mm.
const ANCHOR_TIP_GAP: f64 = 0.1;
/// Smallest thickness above a nut that is recessed into a part, mm.
const MIN_NUT_COVER: f64 = 1.2;
/// Thickness of a strut's floor under its spring, mm.
const STRUT_FLOOR_THICKNESS: f64 = 1.6;
/// Gap between a strut's floor and its spring, mm.
const SPRING_FLOOR_GAP: f64 = 0.15;
/// Gap above a spring's hook, mm.
const HOOK_GAP: f64 = 0.5;
/// Gap between a strut and the screw head that holds it down, mm.
const STRUT_HEAD_GAP: f64 = 0.3;
/// Thickness of a link under the horn's arm, mm.
const HORN_FLOOR_THICKNESS: f64 = 1.8;
/// Thickness of a sleeve's floor and roof, mm.
const SLEEVE_WALL_THICKNESS: f64 = 1.3;
/// Thickness of the leaf that carries a foot, mm: five printed layers.
pub const LEAF_THICKNESS: f64 = 1.0;
/// Height of a pad above the screw head that snaps into it, mm.
pub const PAD_LIP_HEIGHT: f64 = 0.8;
/// Largest height by which a foot's screw can raise the foot, mm: the gap between pad and leaf, which a hex key of this
/// width measures. The screw can lower a foot by more.
const MAX_FOOT_RAISE: f64 = 2.0;
/// Thickness above the nut of a foot's screw, mm.
const FOOT_NUT_COVER: f64 = 1.6;
/// Smallest thickness of a leg's crank above the height of a nut, mm.
const CRANK_NUT_COVER: f64 = 1.0;
/// Gap between a leg's crank and its strut, mm.
const CRANK_STRUT_GAP: f64 = 1.5;
/// Height of the bosses that carry the board, mm.
const BOARD_BOSS_HEIGHT: f64 = 5.0;

/// The heights of all layers of the robot, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stack {
    /// The pads' underside.
    pub floor: f64,
    /// The pads under the feet.
    pub pad: Span,
    /// The flexible leaf that carries a foot, with the foot's recessed nut.
    pub leaf: Span,
    /// The boss on the leaf, around and above the foot's nut.
    pub foot_boss: Span,
    /// The couplers of the legs.
    pub leg_coupler: Span,
    /// The chassis plate.
    pub plate: Span,
    /// The raised seats of the servos.
    pub seat: Span,
    /// The bottom of the servos' cases.
    pub servo_bottom: f64,
    /// Cranks and followers of the legs.
    pub crank: Span,
    /// The bearings of cranks and followers on the plate; they reach higher than the cranks.
    pub bearing: Span,
    /// The anchors on the cranks, which carry the struts.
    pub anchor: Span,
    /// The floors of the struts, on which the springs lie.
    pub strut_floor: Span,
    /// The walls of the struts, beside springs, hooks and screw heads.
    pub strut_wall: Span,
    /// The middle of the spring's coil, and of its hooks.
    pub coil_middle: f64,
    /// The face under the head of a leg anchor's screw, above the hook.
    pub anchor_head_face: f64,
    /// The rigid struts, as high as slotted ones.
    pub rigid_strut: Span,
    /// The servos' links.
    pub link: Span,
    /// The face under the hexagonal heads in the links.
    pub hex_head_face: f64,
    /// The pocket in the links' tops for the horns.
    pub horn_pocket: Span,
    /// The counterbore in the links' tops for the heads of the anchors' screws.
    pub counterbore: Span,
    /// The lower couplers of head and tail.
    pub lower_coupler: Span,
    /// The upper couplers of head and tail.
    pub upper_coupler: Span,
    /// The sleeves of the sliders.
    pub sleeve: Span,
    /// The bores of the sleeves.
    pub bore: Span,
    /// The rods of the sliders.
    pub rod: Span,
    /// The deck, on the standoffs.
    pub deck: Span,
    /// The bosses that carry the board.
    pub board_boss: Span,
}

impl Stack {
    /// Computes the heights of a robot from its parts.
    pub fn new(parts: &Parts) -> Self {
        let (thickness, gap, screw) = (parts.thickness, parts.gap, &parts.screw);
        let span_above =
            |lower_span: Span, height: f64| [lower_span[1] + gap, lower_span[1] + gap + height];
        let seat = [0.0, SEAT_HEIGHT];
        let crank = [gap, gap + thickness.max(screw.nut_height + CRANK_NUT_COVER)];
        let strut_bottom = crank[1] + CRANK_STRUT_GAP;
        let strut_floor = [strut_bottom, strut_bottom + STRUT_FLOOR_THICKNESS];
        let coil_middle = strut_floor[1] + SPRING_FLOOR_GAP + parts.spring.outer_diameter / 2.0;
        let hook_top = coil_middle + parts.spring.wire_diameter / 2.0;
        // The anchor's screw must not touch the plate under its crank.
        let anchor_tip = crank[0] + ANCHOR_TIP_GAP;
        let anchor_head_face = anchor_tip + find_screw_length(hook_top + HOOK_GAP - anchor_tip);
        let wall_top = anchor_head_face - STRUT_HEAD_GAP;
        // The underside of the horn's arm on the shaft.
        let hub_bottom = seat[1] + parts.servo.boss - parts.servo.flange_height + gap;
        let arm_bottom = hub_bottom + parts.horn.height - parts.horn.thickness;
        let link_bottom = arm_bottom - HORN_FLOOR_THICKNESS;
        let link = [link_bottom, link_bottom + thickness];
        let lower_coupler = span_above(link, thickness);
        let bore_bottom = lower_coupler[0] + SLEEVE_WALL_THICKNESS;
        let bore = [bore_bottom, bore_bottom + thickness + 2.0 * parts.fit];
        let rod = [bore[0] + parts.fit, bore[1] - parts.fit];
        let min_length = rod[1] + HEAD_CLEARANCE + screw.nut_height - link[0] - HEX_HEAD_HEIGHT;
        let slider_top = find_screw_length(min_length) + link[0] + HEX_HEAD_HEIGHT;
        let deck = STANDOFF_LENGTHS
            .into_iter()
            .find(|length| *length >= slider_top + gap)
            .unwrap_or(slider_top + gap);
        let pad = [-parts.height, parts.pad.height - parts.height];
        let leaf_bottom = pad[1] + MAX_FOOT_RAISE;
        let leaf_top = leaf_bottom + LEAF_THICKNESS;
        Self {
            floor: -parts.height,
            pad,
            leaf: [leaf_bottom, leaf_top],
            foot_boss: [leaf_top, leaf_bottom + screw.nut_height + FOOT_NUT_COVER],
            leg_coupler: [-thickness - gap, 0.0],
            plate: [-parts.plate, 0.0],
            seat,
            servo_bottom: seat[1] - parts.servo.flange_height,
            crank,
            bearing: [crank[1], crank[0] + BEARING_HEIGHT],
            anchor: [crank[1], strut_floor[0] - HEAD_CLEARANCE],
            strut_floor,
            strut_wall: [strut_floor[1], wall_top],
            coil_middle,
            anchor_head_face,
            hex_head_face: link[0] + HEX_HEAD_HEIGHT,
            rigid_strut: [strut_floor[0], wall_top],
            link,
            horn_pocket: [arm_bottom, link[1]],
            counterbore: [link[1] - screw.head_height - HEAD_CLEARANCE, link[1]],
            lower_coupler,
            upper_coupler: span_above(lower_coupler, thickness),
            sleeve: [lower_coupler[0], bore[1] + SLEEVE_WALL_THICKNESS],
            bore,
            rod,
            deck: [deck, deck + parts.plate],
            board_boss: [deck + parts.plate, deck + parts.plate + BOARD_BOSS_HEIGHT],
        }
    }

    /// Height of the top of the pocket for a leg anchor's nut, mm.
    pub fn anchor_pocket_top(&self, parts: &Parts) -> f64 {
        self.crank[0] + ANCHOR_TIP_GAP + parts.screw.nut_height
    }

    /// Length of a leg anchor's screw, mm.
    pub fn anchor_screw_length(&self) -> f64 {
        self.anchor_head_face - (self.crank[0] + ANCHOR_TIP_GAP)
    }

    /// Height of a pad screw's head above the floor, mm.
    pub fn pad_head_height(&self, parts: &Parts) -> f64 {
        self.pad[1] - PAD_LIP_HEIGHT - parts.screw.head_height - self.floor
    }

    /// True if a leg's crank is thick enough above its recessed nut.
    pub fn crank_holds_nut(&self, parts: &Parts) -> bool {
        self.anchor[1] - self.anchor_pocket_top(parts) >= MIN_NUT_COVER
    }
}

/// Finds the shortest common screw length of at least `min`, mm; `min` if all common lengths are shorter.
pub fn find_screw_length(min: f64) -> f64 {
    let mut lengths = SCREW_LENGTHS.into_iter();
    lengths.find(|length| *length >= min - 1e-9).unwrap_or(min)
}

/// True if this is a common screw length, mm.
pub fn is_common_screw_length(length: f64) -> bool {
    let mut lengths = SCREW_LENGTHS.iter();
    lengths.any(|stock_length| (stock_length - length).abs() < 1e-9)
}
