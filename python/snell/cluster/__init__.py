"""Pictures made by many machines: `Scene.render` and `snell.sweep` with the ``client`` of a Dask cluster.

``plan`` says which rows and samples make one task, ``tasks`` what a worker does, ``engine`` hands tasks out and
collects what comes back. Which machine does what, and what happens if one is lost, is left to `dask.distributed`.
"""
