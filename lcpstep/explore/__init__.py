"""`lcpstep explore`: a scene on a local page, with sliders and a basin to click into. Needs Bokeh (extra `explore`).

`views` says what is seen of a run, in numbers; `session` what one visitor looks at; `page` and `basin_panel` draw it;
`server` shows it on this machine alone.
"""
