//! Skins of bodies, for programs that draw or touch them.

use super::Simulation;
use crate::error::Error;
use crate::observation::{SkinState, skin_of};

impl Simulation {
    /// The skin of a body as it is now: the fine surface that its mesh carries, without what has been removed.
    ///
    /// # Errors
    /// A body that there is not, or that has no `skin` in the scene. What the GPU says.
    pub fn skin(&mut self, body: &str) -> Result<SkinState, Error> {
        self.settle()?;
        let entity = self.body(body)?;
        let found = skin_of(&mut self.world, entity)?;
        found.ok_or_else(|| Error::Options(format!("the body `{body}` has no `skin` in the scene")))
    }
}
