"""The pages that learning platforms open by LTI, in a frame or in a separate window."""
