//! Commands that compare two scenes, or a scan with a scene.

pub(crate) mod align;
pub(crate) mod deviation;
pub(crate) mod distance;
pub(crate) mod hausdorff;
pub(crate) mod scan;
pub(crate) mod scene_pair;
