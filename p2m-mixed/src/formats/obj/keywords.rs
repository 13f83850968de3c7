//! Keywords of OBJ files whose statements are skipped.

/// Returns whether a keyword belongs to free-form curves and surfaces, superseded keywords included.
pub(super) fn is_free_form(keyword: &[u8]) -> bool {
    "cstype deg bmat step curv curv2 surf parm trim hole scrv sp end con bzp bsp cdc cdp res"
        .split(' ')
        .any(|known| known.as_bytes() == keyword)
}

/// Returns whether a keyword is one of OBJ that does not affect the geometry.
pub(super) fn is_known(keyword: &[u8]) -> bool {
    "vt vn vp g s o mg usemtl mtllib usemap maplib bevel c_interp d_interp lod shadow_obj trace_obj ctech stech call \
     csh"
    .split(' ')
    .any(|known| known.as_bytes() == keyword)
}
