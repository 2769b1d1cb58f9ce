"""The pages that platforms open by LTI: launches in a frame or in a window of their own."""
