//! The JavaScript class that calibrates a robot.
#![allow(clippy::missing_errors_doc)] // each rejects with the page's own error, or with a message about the refusal

use lizard_calibrate::{ReplaceError, SCALE_TURNS_DEG, SIGN_TURNS_DEG};
use wasm_bindgen::prelude::*;

use crate::calibration::{from_js, to_js};
use crate::console::{Console, JsConsole, error_to_js, make_js_error};

/// A calibration in progress. Angles are in deg, counter-clockwise; servos 0 to 3 are A1 to A4. Only one function runs
/// at a time: every other call throws until the function's promise has settled.
#[wasm_bindgen]
#[derive(Debug)]
pub struct Calibrator(lizard_calibrate::Session<JsConsole>);

#[wasm_bindgen]
impl Calibrator {
    /// Reads the robot's calibration; nothing moves.
    pub async fn begin(console: Console) -> Result<Self, JsValue> {
        let session = lizard_calibrate::Session::begin(JsConsole(console)).await;
        session.map(Self).map_err(error_to_js)
    }

    /// The robot's calibration, saved or not.
    #[wasm_bindgen(getter, unchecked_return_type = "Calibration")]
    pub fn calibration(&self) -> JsValue {
        to_js(self.0.calibration())
    }

    /// True if the calibration is not saved, or if it is unknown whether it is saved.
    #[wasm_bindgen(getter, js_name = isChanged)]
    pub fn is_changed(&self) -> bool {
        self.0.has_unsaved_changes()
    }

    /// Returns true if a reset of the robot was noticed since the last call. A reset loses the unsaved settings.
    #[wasm_bindgen(js_name = takeReset)]
    pub fn take_reset(&mut self) -> bool {
        self.0.take_reset()
    }

    /// Reads the calibration again, because another part of the page may have changed it.
    #[wasm_bindgen(js_name = readAgain)]
    pub async fn read_again(&mut self) -> Result<(), JsValue> {
        self.0.read_again().await.map_err(error_to_js)
    }

    /// Makes the robot stand.
    pub async fn stand(&mut self) -> Result<(), JsValue> {
        self.0.stand().await.map(drop).map_err(error_to_js)
    }

    /// Ends the pulses, so that no servo moves when the supply is switched on.
    pub async fn rest(&mut self) -> Result<(), JsValue> {
        self.0.rest().await.map_err(error_to_js)
    }

    /// Moves every servo to its middle, without its trim, for fitting the horns.
    #[wasm_bindgen(js_name = centerServos)]
    pub async fn center_servos(&mut self) -> Result<(), JsValue> {
        self.0.center_servos().await.map_err(error_to_js)
    }

    /// Turns one servo from its neutral angle far enough to see its direction; returns the turn.
    #[wasm_bindgen(js_name = turnToCheckSign)]
    pub async fn turn_to_check_sign(&mut self, servo: usize) -> Result<f64, JsValue> {
        let turn = self.0.turn_servo(servo, &SIGN_TURNS_DEG).await;
        turn.map_err(error_to_js)
    }

    /// Turns one servo from its neutral angle far enough to measure its scale; returns the turn.
    #[wasm_bindgen(js_name = turnToMeasureScale)]
    pub async fn turn_to_measure_scale(&mut self, servo: usize) -> Result<f64, JsValue> {
        let turn = self.0.turn_servo(servo, &SCALE_TURNS_DEG).await;
        turn.map_err(error_to_js)
    }

    /// Moves one servo to an angle, and the other servos to neutral; returns the angle, 0 to 360.
    #[wasm_bindgen(js_name = moveServo)]
    pub async fn move_servo(&mut self, servo: usize, degrees: f64) -> Result<f64, JsValue> {
        self.0.move_servo(servo, degrees).await.map_err(error_to_js)
    }

    /// Reverses the sign of a servo.
    #[wasm_bindgen(js_name = reverseSign)]
    pub async fn reverse_sign(&mut self, servo: usize) -> Result<(), JsValue> {
        self.0.reverse_sign(servo).await.map_err(error_to_js)
    }

    /// Changes a servo's trim by this angle.
    #[wasm_bindgen(js_name = changeTrim)]
    pub async fn change_trim(&mut self, servo: usize, change: f64) -> Result<(), JsValue> {
        self.0.change_trim(servo, change).await.map_err(error_to_js)
    }

    /// Sets the scale of a servo that turned by `measured` instead of `commanded`; returns the scale, us per deg.
    #[wasm_bindgen(js_name = setScaleFromTurn)]
    pub async fn set_scale_from_turn(
        &mut self,
        servo: usize,
        commanded: f64,
        measured: f64,
    ) -> Result<f64, JsValue> {
        let scale = self.0.set_scale_from_turn(servo, commanded, measured).await;
        scale.map_err(error_to_js)
    }

    /// Sets a servo's travel, counter-clockwise from the first angle to the second.
    #[wasm_bindgen(js_name = setLimit)]
    pub async fn set_limit(&mut self, servo: usize, from: f64, to: f64) -> Result<(), JsValue> {
        let outcome = self.0.set_limit(servo, [from, to]).await;
        outcome.map_err(error_to_js)
    }

    /// Starts `walk`, or else the first moving gait; returns the gait's name, or undefined if no gait moves.
    #[wasm_bindgen(js_name = startWalk)]
    pub async fn start_walk(&mut self) -> Result<Option<String>, JsValue> {
        self.0.start_walk().await.map_err(error_to_js)
    }

    /// Saves the calibration in the board's EEPROM.
    pub async fn save(&mut self) -> Result<(), JsValue> {
        self.0.save().await.map_err(error_to_js)
    }

    /// Makes the robot stand, and restores the calibration from the start or from the last save; returns true if the
    /// calibration changed.
    pub async fn restore(&mut self) -> Result<bool, JsValue> {
        self.0.restore().await.map_err(error_to_js)
    }

    /// Replaces the calibration without saving it. If the robot refuses the new calibration, restores the previous one.
    pub async fn replace(
        &mut self,
        #[wasm_bindgen(unchecked_param_type = "Calibration")] calibration: JsValue,
    ) -> Result<(), JsValue> {
        let outcome = self.0.replace(&from_js(&calibration)?).await;
        outcome.map_err(|error| match error {
            ReplaceError::Refused(error) | ReplaceError::Mixed(error) => error_to_js(error),
            ReplaceError::Differs => {
                make_js_error("The robot did not accept the whole calibration.")
            }
        })
    }
}
