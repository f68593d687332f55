;; Emacs 29 or later, with glsl-mode: put this into init.el.
(with-eval-after-load 'eglot
  (add-to-list 'eglot-server-programs '(glsl-mode . ("glisten" "lsp"))))
(add-hook 'glsl-mode-hook #'eglot-ensure)
